#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace haptoflow::engine {

/// Percentiles of a stream of values in a fixed 2 MiB. Values that differ by less than 0.1 % may share a bin.
/// Construction allocates: not on the audio thread.
class ValueHistogram {
public:
    ValueHistogram();

    /// Negative values and NaN count as 0.
    void add(float value) noexcept;
    [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
    /// The value at rank `share` * (count - 1), rounded down, with `share` from 0 to 1; 0 if the histogram is empty.
    /// The result is the lower end of the bin, at most 0.1 % below the actual value.
    [[nodiscard]] float valueAtShare(double share) const noexcept;
    /// Number of values in bins above that of `value`.
    [[nodiscard]] std::uint64_t countAbove(float value) const noexcept;

private:
    std::vector<std::uint64_t> bins_;
    std::uint64_t count_ = 0;
};

/// How much the seams between segments differ from the rest of the waveform.
struct SeamStatistics {
    std::size_t seams = 0;
    /// Share of seams with a sample difference above the 99.9th percentile of all sample differences.
    double outlierShare = 0.0;
    /// RMS of the sample differences in seams divided by the RMS of all others.
    double jumpRatio = 0.0;
};

/// Measures seams in a waveform (2 kHz, as played, before resampling) that arrives piece by piece; memory does not grow
/// with its length. A seam is the step to the sample at which a segment takes over and the steps inside its splice.
/// Differences within 0.1 % of the percentile count as equal to it.
class SeamMeter {
public:
    explicit SeamMeter(std::size_t spliceSamples);

    /// Announces that a segment takes over at a sample, an index into the waveform. Call in ascending order and before
    /// that sample is added.
    void addSeam(std::int64_t sample);
    void addSamples(std::span<const float> waveform);
    /// Statistics of everything added so far.
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
    // Seams whose splice has not ended.
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
