#pragma once

#include "effects/effect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

/// Multiplies a wave by a gain that follows its envelope: a compressor that does not bend the waveform.
///
/// The wave is cut into steps of half a millisecond. The envelope is the largest magnitude of the last 9 ms (half a
/// period of 56 Hz, so that a slow sinusoid does not modulate its own gain), and falls by 1/e in 20 ms afterwards. The
/// gain changes linearly within each step and is never above the gain of the envelope that a step has; the wave is
/// delayed by two steps for that. With a law whose gain falls as the envelope rises, the output thereby never exceeds
/// what the law gives for the envelope, not even at an onset.
///
/// Non-finite samples count as 0, magnitudes are limited to 1e6. Used by one thread at a time. Allocates nothing.
class EnvelopeGain {
public:
    /// Delay of the wave. At rates that are not a multiple of 2 kHz, the next whole number of samples.
    static constexpr double latencySeconds = 0.001;

    /// Gain for an envelope of 0 or more; finite, 0 or more, and not rising with the envelope.
    using Law = float (*)(float envelope);

    /// Throws std::invalid_argument for a rate outside 2-192 kHz.
    EnvelopeGain(double sampleRateHz, Law law);

    void process(std::span<float> samples) noexcept;
    /// Silence from here on, with the gain of silence.
    void reset() noexcept;
    /// Silence from here on after an envelope of this size, from which the gain rises within the time of the release.
    void begin(float envelope) noexcept;
    /// True while silent input gives silent output.
    [[nodiscard]] bool isIdle() const noexcept { return silentSteps_ > delaySteps; }

private:
    static constexpr std::size_t delaySteps = 2;
    static constexpr std::size_t longestStep = 96;
    static constexpr std::size_t holdSteps = 18;

    void finishStep() noexcept;

    Law law_;
    std::size_t stepSamples_;
    std::array<float, delaySteps * longestStep> delayed_{};
    std::size_t place_ = 0;
    std::array<float, holdSteps> peaks_{};
    std::size_t peakPlace_ = 0;
    std::size_t inStep_ = 0;
    float peak_ = 0.0F;
    float envelope_ = 0.0F;
    /// Gain of the newest complete step, and the gains at the two ends of the step that is played.
    float newestGain_ = 0.0F;
    float gainFrom_ = 0.0F;
    float gainTo_ = 0.0F;
    std::size_t silentSteps_ = 0;
};

/// Makes a vibration audible on loudspeakers: for ears, never for an actuator.
///
/// A texture at its true level lies some 40 dB below full scale, with most of its energy where a laptop's loudspeakers
/// play nothing. This effect brightens it by two shelves of 6 dB an octave from 150 to 1500 Hz, then brings the
/// envelope towards the full scale: an envelope E of the brightened wave becomes
///
///   middleShare * (E / E_m)^p of the full scale, bent above 0.7, at most 0.9.
///
/// A new one opens within a tenth of a second from a gain near 1, so that switching it on makes no click; `reset`, for
/// a silent voice, opens it at once.
///
/// The exponent keeps the order of labels and of forces. Delay: EnvelopeGain::latencySeconds. The limiter follows after
/// this effect. Finite and bounded for any input; reads no field of the contact.
class Listen final : public Effect {
public:
    /// `fullScaleMps2`: the acceleration that is +-1 at the output. Throws std::invalid_argument for a rate outside
    /// 8-192 kHz or a full scale that is not above 0.
    Listen(double sampleRateHz, double fullScaleMps2);

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override;

private:
    /// y(n) = in0 x(n) + in1 x(n-1) + back y(n-1).
    struct Shelf {
        double in = 0.0;
        double out = 0.0;
    };

    [[nodiscard]] double brightened(double sample) noexcept;

    double in0_ = 0.0;
    double in1_ = 0.0;
    double back_ = 0.0;
    float fullScaleMps2_;
    std::array<Shelf, 2> shelves_{};
    EnvelopeGain gain_;
};

/// How a device in the hand takes a vibration. Each kind has a level of its own.
enum class DeviceKind : std::uint8_t {
    /// One amplitude at a time, for a motor.
    motor,
    /// Amplitude and frequency over time.
    parametric,
    /// The waveform itself.
    waveform
};
inline constexpr std::size_t deviceKinds = 3;

/// The loudness law: the share of a device's range, 0 to below 1, for an acceleration amplitude in m/s^2 (peak).
///
/// What is felt grows as a power of the amplitude above the threshold (Stevens), and from threshold to discomfort is
/// some 55 dB, of which a small motor offers perhaps 30. A straight proportion therefore leaves most textures where a
/// motor does not move. With L = 20 log10(A / T), the sensation level above the threshold T of 160 Hz (0.03 m/s^2):
///
///   d = middleShare * (A / A_m)^p = middleShare * 10^(p (L - L_m) / 20)
///
/// A_m, the middle label's median at an ordinary stroke, is played at middleShare; the exponent p puts the strongest
/// label's 90th percentile at 1. Above 0.7 the curve bends and approaches 1; below the threshold it is a straight line
/// to 0. It rises everywhere, so that the order of any two amplitudes stays. A_m and p are fitted for each kind to the
/// shipped model (scripts/pack/device_levels.py prints them and the levels that result).
///
/// A is the amplitude of equal intensity of WaveFeatures for motor and parametric, which is weighted by
/// ThresholdFilter. For the waveform it is the envelope, unweighted: its peak must fit into the range, and the skin
/// itself weights what the device plays.
inline constexpr double middleShare = 0.35;

/// Any thread; allocates nothing. An amplitude that is not above 0 gives 0, infinity the largest float below 1.
[[nodiscard]] float deviceShare(DeviceKind kind, float amplitudeMps2) noexcept;

/// A compressing gain that follows the envelope by `deviceShare` of the waveform: m/s^2 in, a device's +-1 out. Throws
/// std::invalid_argument for a rate outside 2-192 kHz.
[[nodiscard]] EnvelopeGain deviceWave(double sampleRateHz);

}  // namespace haptoflow::effects
