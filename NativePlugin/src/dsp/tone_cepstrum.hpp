#pragma once

#include <array>
#include <cstddef>
#include <functional>

namespace haptoflow::dsp {

inline constexpr std::size_t toneTaps = 64;

/// The impulse response of a tone: a minimum-phase filter for samples at 2 kHz.
using ToneKernel = std::array<float, toneTaps>;

/// The beginning of the complex cepstrum of a minimum-phase filter. What multiplies magnitudes adds cepstra, and a mean
/// of gains in dB is the mean of their cepstra: tones are mixed and composed here, and made kernels afterwards.
using ToneCepstrum = std::array<double, toneTaps>;

/// Gain in dB at a frequency in Hz.
using ToneGain = std::function<double(double frequencyHz)>;

/// The cepstrum of the tone whose gain is `gainDb`, asked at 129 frequencies from 0 to 1,000 Hz. Allocates.
[[nodiscard]] ToneCepstrum toneCepstrum(const ToneGain& gainDb);

/// The kernel of a cepstrum; it passes what it leaves alone undelayed. Allocates nothing.
[[nodiscard]] ToneKernel toneKernel(const ToneCepstrum& cepstrum) noexcept;

}  // namespace haptoflow::dsp
