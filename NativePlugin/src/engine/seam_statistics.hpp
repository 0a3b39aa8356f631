#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// How well the seams between segments hide in the waveform around them.
struct SeamStatistics {
    std::size_t seams = 0;
    /// Share of seams with a sample difference above the wave's own 99.9th percentile of sample differences.
    double outlierShare = 0.0;
    /// RMS of the sample differences in the seams over the RMS of all others.
    double jumpRatio = 0.0;
};

/// `seams` are the take-over samples, indices into `waveform` (2 kHz, as played, before resampling). A seam is the step
/// onto the take-over sample and, where a splice of `spliceSamples` follows, the steps inside it.
[[nodiscard]] SeamStatistics measureSeams(std::span<const float> waveform, std::span<const std::int64_t> seams,
                                          std::size_t spliceSamples);

}  // namespace haptoflow::engine
