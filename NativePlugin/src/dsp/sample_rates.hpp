#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace haptoflow::dsp {

/// Rate of every generated and recorded waveform, in Hz. Effects and outputs run at the device's rate instead.
inline constexpr double waveformRateHz = 2000.0;
/// Length of a segment at that rate: 100 ms.
inline constexpr std::size_t segmentSamples = 200;

/// Range of output rates, in Hz.
inline constexpr double minimumOutputRateHz = 8000.0;
inline constexpr double maximumOutputRateHz = 192000.0;

/// False for NaN too.
[[nodiscard]] constexpr bool isOutputRate(double rateHz) noexcept {
    return rateHz >= minimumOutputRateHz && rateHz <= maximumOutputRateHz;
}

/// Returns `rateHz`. Throws std::invalid_argument outside 8000 to 192000 Hz.
inline double requireOutputRate(double rateHz) {
    if (!isOutputRate(rateHz)) {
        throw std::invalid_argument("output rate is " + std::to_string(rateHz) + " Hz; expected 8000 to 192000 Hz");
    }
    return rateHz;
}

/// Returns `rateHz`. Throws std::invalid_argument unless it is an output rate or the waveform rate.
inline double requireSampleRate(double rateHz) {
    return rateHz == waveformRateHz ? rateHz : requireOutputRate(rateHz);
}

}  // namespace haptoflow::dsp
