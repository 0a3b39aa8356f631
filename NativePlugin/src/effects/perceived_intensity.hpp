#pragma once

namespace haptoflow::effects {

/// How intense a vibration of a held stylus feels, for replacing one by another that feels as intense.
///
/// A sinusoid of amplitude A (peak, m/s^2) at frequency f is r = A / T(f) times its detection threshold and has the
/// perceived intensity
///   I = r^a(f)                     up to I_c = 42.4,
///   I = I_c (r / r_c)^0.89         above, r_c = I_c^(1 / a(f)).
/// I is 1 at the threshold, whatever the frequency. Of a mixture the energies add up, each over its own threshold
/// (r^2 = sum A_i^2 / T_i^2: "spectral power summed across all frequencies", as Cao et al. 2018 put the established
/// model), and a is the mean weighted by them.
///
/// Sources. The shape is that of Intensity Segment Modulation (Konyo and others, IEEE World Haptics Conference 2021,
/// document 9517147) and of the models before it: threshold and exponent are tables over frequency. Their numbers could
/// not be had; those here are approximate, interpolated on logarithmic scales between constraints that are published:
/// - T: 26 um at 10 Hz for a stylus held as a pen (Israr, Choi and Tan 2006, as cited by others); least displacement
///   between 150 and 200 Hz, below 0.01 um for some, and a steeper slope than others had found (Brisben, Hsiao and
///   Johnson 1999, a grasped cylinder; the others' is 12 dB an octave, Verrillo 1963, a pad on the palm); greatest
///   sensitivity to acceleration around 125 Hz (Griffin 2012, a gripping hand). Above 250 Hz 12 dB an octave in
///   displacement, the mirrored slope, was assumed. What is below 10 Hz is movement rather than vibration: sensitivity
///   to it was made to fall with frequency.
/// - a: 1 at 60 Hz, largest near 30 Hz, smallest towards 250 Hz, about half of the largest (Stevens 1968). Between
///   those the table follows from contours of equal intensity that run parallel to the threshold at low levels and
///   along equal velocity at high ones (Griffin 2012, 16-400 Hz): a(f) = ln I_c / ln(2 pi f v / T(f)) with v = 5 mm/s,
///   chosen so that the largest exponent is twice the smallest; I_c is what a(60 Hz) = 1 makes of it. So the smallest
///   exponent lies at 160 Hz. Constant below 30 and above 400 Hz, where there is no such data.
/// - 0.89 above that contour: the slope at all frequencies up to 350 Hz (Verrillo 1970). With it the contours stay
///   parallel to equal velocity instead of drifting apart for ever.
/// Only relations between frequencies and levels matter to the rendering, not the absolute threshold.
///
/// All functions: any thread, no allocation. Frequencies are Hz and amplitudes m/s^2; what is not above 0 has the
/// threshold of 1 Hz or no intensity.

/// The contour above which all exponents are the same.
inline constexpr double contourIntensity = 42.4;
inline constexpr double exponentAboveContour = 0.89;

/// T: amplitude (peak, m/s^2) of a sinusoid that is just felt.
[[nodiscard]] double detectionThresholdMps2(double frequencyHz) noexcept;
/// a: by how much faster intensity grows than amplitude, on logarithmic scales.
[[nodiscard]] double intensityExponent(double frequencyHz) noexcept;
/// I of r times the threshold, with a given exponent.
[[nodiscard]] double intensityOfRatio(double ratio, double exponent) noexcept;
/// The inverse: r for an intensity.
[[nodiscard]] double ratioOfIntensity(double intensity, double exponent) noexcept;
/// I of a sinusoid.
[[nodiscard]] double intensityOfSinusoid(double amplitudeMps2, double frequencyHz) noexcept;
/// The amplitude of a sinusoid that is as intense: the inverse of `intensityOfSinusoid`.
[[nodiscard]] double amplitudeOfIntensity(double intensity, double frequencyHz) noexcept;

}  // namespace haptoflow::effects
