#pragma once

#include "engine/value_histogram.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
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

/// Measures seams while the waveform (2 kHz, as played, before resampling) comes in, in memory that does not grow with
/// it. A seam is the step onto the take-over sample and, where a splice follows, the steps inside it. Sizes within
/// 0.1 % of the percentile count as equal to it.
class SeamMeter {
public:
    explicit SeamMeter(std::size_t spliceSamples);

    /// A segment takes over at that sample, an index into the waveform; ascending, and told before the sample is added.
    void addSeam(std::int64_t sample);
    void addSamples(std::span<const float> waveform);
    /// Of everything added so far.
    [[nodiscard]] SeamStatistics statistics() const;

private:
    struct Seam {
        std::int64_t begin = 0;
        float largest = 0.0F;
    };

    void addDifference(float difference);

    std::int64_t spliceSamples_;
    std::int64_t next_ = 0;
    float last_ = 0.0F;
    // Those whose splice is not over.
    std::deque<Seam> open_;
    ValueHistogram differences_;
    ValueHistogram largestOfSeams_;
    std::size_t seams_ = 0;
    double seamSquares_ = 0.0;
    double otherSquares_ = 0.0;
    std::uint64_t seamSteps_ = 0;
    std::uint64_t otherSteps_ = 0;
};


}  // namespace haptoflow::engine
