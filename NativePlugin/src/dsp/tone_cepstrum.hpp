#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <numbers>

namespace haptoflow::dsp {

/// Natural logarithm of the amplitude ratio that 1 dB stands for.
inline constexpr double nepersPerDecibel = std::numbers::ln10 / 20.0;

inline constexpr std::size_t toneTaps = 64;

/// Impulse response of a tone: a minimum-phase filter at the waveform rate.
using ToneKernel = std::array<float, toneTaps>;

/// The first coefficients of a minimum-phase filter's complex cepstrum. Adding cepstra multiplies the filters'
/// magnitudes, and a mean of cepstra is the filter with the mean gain in dB; so tones are mixed as cepstra and turned
/// into kernels afterwards.
using ToneCepstrum = std::array<double, toneTaps>;

/// Gain in dB at a frequency in Hz.
using ToneGain = std::function<double(double frequencyHz)>;

/// Cepstrum of the tone with the gain `gainDb`, which is evaluated at 129 frequencies from 0 to 1,000 Hz. Allocates.
[[nodiscard]] ToneCepstrum toneCepstrum(const ToneGain& gainDb);

/// Kernel of a cepstrum. A gain of 0 dB at all frequencies gives a unit impulse without delay. Allocates nothing.
[[nodiscard]] ToneKernel toneKernel(const ToneCepstrum& cepstrum) noexcept;

}  // namespace haptoflow::dsp
