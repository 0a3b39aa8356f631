#pragma once

#include "effects/envelope_gain.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

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

/// The wave in m/s^2 to a device's +-1: a compressing gain that follows the envelope by `deviceShare`.
class DeviceWave {
public:
    static constexpr double latencySeconds = EnvelopeGain::latencySeconds;

    /// Throws std::invalid_argument for a rate outside 2-192 kHz.
    explicit DeviceWave(double sampleRateHz);

    /// In place: m/s^2 in, +-1 out. Allocates nothing.
    void process(std::span<float> samples) noexcept { gain_.process(samples); }
    void reset() noexcept { gain_.reset(); }

private:
    EnvelopeGain gain_;
};

}  // namespace haptoflow::effects
