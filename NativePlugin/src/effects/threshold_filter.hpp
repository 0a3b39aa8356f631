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

}  // namespace haptoflow::effects
