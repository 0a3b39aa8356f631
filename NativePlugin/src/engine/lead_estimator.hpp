#pragma once

#include "dsp/sample_rates.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// How many waveform samples a new segment has to lead the read head by, learnt from how far the head came between the
/// snapshot that a segment was planned with and the block that took it. That distance holds everything that delays a
/// segment: inference, scheduling, the blocks of the callback and their bursts. Worker thread.
class LeadEstimator {
public:
    static constexpr std::int64_t minimumSamples = 2;
    /// 50 ms. A segment that takes longer is late.
    static constexpr double maximumMs = 50.0;
    static constexpr std::int64_t maximumSamples = 100;
    static_assert(maximumMs * dsp::waveformRateHz == maximumSamples * 1000.0);

    /// Waveform samples in a lead stated in milliseconds, rounded up.
    [[nodiscard]] static std::int64_t samplesOf(double milliseconds) noexcept {
        return static_cast<std::int64_t>(std::ceil(milliseconds * dsp::waveformRateHz / 1000.0));
    }

    /// What one segment needed, at a reading rate of 1.
    void observe(std::int64_t advancedSamples) noexcept;
    /// The 99th percentile of the last observations and one sample more; never less than the largest block.
    [[nodiscard]] std::int64_t samples(std::int64_t blockAdvance) const noexcept;

private:
    // Of so many the second largest is the 99th percentile: one stall does not lengthen the lead, two do.
    static constexpr std::size_t window = 128;
    // Before anything was measured: two blocks and 4 ms.
    static constexpr std::int64_t guessedInference = 8;

    std::array<std::int64_t, window> advances_{};
    std::size_t count_ = 0;
};

}  // namespace haptoflow::engine
