#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::effects {

/// Weights a 2 kHz wave by 1 / T(f), the inverse of the detection threshold, so that the output is in multiples of the
/// threshold. A minimum-phase FIR filter of 64 ms, designed from the table through its real cepstrum; it has the least
/// delay for its magnitude. Within 0.1 dB of the table from 30 to 400 Hz.
class ThresholdFilter {
public:
    static constexpr std::size_t taps = 128;

    /// The one filter, designed at first use and immutable afterwards. The design takes about a millisecond: not on the
    /// audio thread.
    [[nodiscard]] static const ThresholdFilter& shared();

    /// h(0), h(1), ... at 2 kHz.
    [[nodiscard]] std::span<const double, taps> impulseResponse() const noexcept { return impulseResponse_; }
    /// Group delay in samples at 125 Hz, where the hand is most sensitive.
    [[nodiscard]] double delaySamples() const noexcept { return delaySamples_; }

private:
    ThresholdFilter();

    std::array<double, taps> impulseResponse_{};
    double delaySamples_ = 0.0;
};

/// Perceived intensity of a vibration of a held stylus, used to replace a vibration by another of equal intensity.
///
/// A sinusoid of amplitude A (peak, m/s^2) at frequency f is r = A / T(f) times its detection threshold and has the
/// perceived intensity
///   I = r^a(f) up to I_c = 42.4,
///   I = I_c (r / r_c)^0.89 above, r_c = I_c^(1 / a(f)). I is 1 at the threshold of every frequency. In a mixture,
///   energies relative to their thresholds add up (r^2 = sum A_i^2 / T_i^2: "spectral power summed across all
///   frequencies", as Cao et al. 2018 describe the established model), and a is the mean weighted by these energies.
///
/// Sources. The form is that of Intensity Segment Modulation (Konyo and others, IEEE World Haptics Conference 2021,
/// document 9517147) and of earlier models: threshold and exponent are tables over frequency. The original tables are
/// not public. The values here are approximate; they interpolate, on logarithmic scales, between published constraints:
/// - T: 26 um at 10 Hz for a stylus held like a pen (Israr, Choi and Tan 2006, as cited by others); minimum
///   displacement between 150 and 200 Hz, below 0.01 um for some subjects, with a steeper slope than in earlier studies
///   (Brisben, Hsiao and Johnson 1999, a grasped cylinder; the earlier slope is 12 dB/octave, Verrillo 1963, a pad on
///   the palm); maximum sensitivity to acceleration around 125 Hz (Griffin 2012, a gripping hand). Above 250 Hz the
///   mirrored slope of 12 dB/octave in displacement is assumed. Below 10 Hz, which is movement rather than vibration,
///   the sensitivity is set to decrease with decreasing frequency.
/// - a: 1 at 60 Hz, largest near 30 Hz, smallest towards 250 Hz at about half of the largest (Stevens 1968). Between
///   these points, contours of equal intensity run parallel to the threshold at low levels and along equal velocity at
///   high levels (Griffin 2012, 16-400 Hz): a(f) = ln I_c / ln(2 pi f v / T(f)). v = 5 mm/s makes the largest exponent
///   twice the smallest, and a(60 Hz) = 1 determines I_c. The smallest exponent then lies at 160 Hz. a is constant
///   below 30 Hz and above 400 Hz, where no such data exist.
/// - 0.89 above that contour: the slope at all frequencies up to 350 Hz (Verrillo 1970). It keeps the contours parallel
///   to equal velocity. The rendering depends only on the relations between frequencies and levels, not on the absolute
///   threshold.
///
/// All functions: any thread, no allocation. Frequencies are in Hz, amplitudes in m/s^2. A frequency that is not above
/// 0 gets the threshold of 1 Hz; an amplitude that is not above 0 has no intensity.

/// The intensity above which the exponent is the same at all frequencies.
inline constexpr double contourIntensity = 42.4;
inline constexpr double exponentAboveContour = 0.89;

/// T: peak amplitude in m/s^2 of a sinusoid at the detection threshold.
[[nodiscard]] double detectionThresholdMps2(double frequencyHz) noexcept;
/// a: slope of intensity over amplitude on logarithmic scales.
[[nodiscard]] double intensityExponent(double frequencyHz) noexcept;
/// I for r times the threshold with the given exponent.
[[nodiscard]] double intensityOfRatio(double ratio, double exponent) noexcept;
/// r for an intensity: the inverse of `intensityOfRatio`.
[[nodiscard]] double ratioOfIntensity(double intensity, double exponent) noexcept;
/// I of a sinusoid.
[[nodiscard]] double intensityOfSinusoid(double amplitudeMps2, double frequencyHz) noexcept;
/// Amplitude of a sinusoid with the given intensity: the inverse of `intensityOfSinusoid`.
[[nodiscard]] double amplitudeOfIntensity(double intensity, double frequencyHz) noexcept;

}  // namespace haptoflow::effects
