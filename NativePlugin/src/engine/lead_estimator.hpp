#pragma once

#include "dsp/sample_rates.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// Estimates the lead: the number of waveform samples between the read head and the start of a new segment. It learns
/// from the distance that the head moved between the planning of a segment and the block that took it. That distance
/// includes every delay: inference, scheduling, the callback's blocks and their bursts. Worker thread.
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

    /// Adds the lead that one segment needed, at a reading rate of 1.
    void observe(std::int64_t advancedSamples) noexcept;
    /// The 99th percentile of the last observations plus one sample, and at least `blockAdvance`, the longest block.
    [[nodiscard]] std::int64_t samples(std::int64_t blockAdvance) const noexcept;

private:
    // Of this many observations, the second largest is the 99th percentile: one stall does not lengthen the lead, two
    // do.
    static constexpr std::size_t window = 128;
    // Without observations, the lead is two blocks and 4 ms.
    static constexpr std::int64_t initialInferenceSamples = 8;

    std::array<std::int64_t, window> advances_{};
    std::size_t count_ = 0;
};

}  // namespace haptoflow::engine
