#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::effects {

/// Weighs a wave of 2 kHz by 1 / T(f), the inverse of the detection threshold: what comes out is in multiples of what
/// is just felt. A minimum-phase filter of 64 ms, designed from the table through its real cepstrum, so that a jump
/// comes out as early as that magnitude allows. Within 0.1 dB of the table from 30 to 400 Hz.
class ThresholdFilter {
public:
    static constexpr std::size_t taps = 128;

    /// Designed once, at first use; that takes about a millisecond, and not on the audio thread. Immutable afterwards.
    [[nodiscard]] static const ThresholdFilter& shared();

    /// h(0), h(1), ... at 2 kHz.
    [[nodiscard]] std::span<const double, taps> impulseResponse() const noexcept { return impulseResponse_; }
    /// Group delay at 125 Hz, where the hand is most sensitive, in samples.
    [[nodiscard]] double delaySamples() const noexcept { return delaySamples_; }

private:
    ThresholdFilter();

    std::array<double, taps> impulseResponse_{};
    double delaySamples_ = 0.0;
};

}  // namespace haptoflow::effects
