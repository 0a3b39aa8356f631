#include "engine/seam_statistics.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace haptoflow::engine {
namespace {

// For non-negative floats, the order of the bit patterns equals the order of the values. The bin is the exponent and
// the first ten bits of the fraction.
constexpr unsigned droppedBits = 13;
constexpr std::size_t binCount = std::size_t{1} << (31U - droppedBits);

std::size_t binOf(float value) noexcept {
    return value > 0.0F ? std::bit_cast<std::uint32_t>(value) >> droppedBits : 0;
}

}  // namespace

ValueHistogram::ValueHistogram() : bins_(binCount, 0) {}

void ValueHistogram::add(float value) noexcept {
    ++bins_[binOf(value)];
    ++count_;
}

float ValueHistogram::valueAtShare(double share) const noexcept {
    if (count_ == 0) {
        return 0.0F;
    }
    const auto rank = static_cast<std::uint64_t>(share * static_cast<double>(count_ - 1));
    std::uint64_t below = 0;
    for (std::size_t bin = 0; bin < bins_.size(); ++bin) {
        below += bins_[bin];
        if (below > rank) {
            return std::bit_cast<float>(static_cast<std::uint32_t>(bin << droppedBits));
        }
    }
    return 0.0F;
}

std::uint64_t ValueHistogram::countAbove(float value) const noexcept {
    std::uint64_t above = 0;
    for (std::size_t bin = binOf(value) + 1; bin < bins_.size(); ++bin) {
        above += bins_[bin];
    }
    return above;
}

SeamMeter::SeamMeter(std::size_t spliceSamples)
    : spliceSamples_(static_cast<std::int64_t>(std::max<std::size_t>(spliceSamples, 1))) {}

void SeamMeter::addSeam(std::int64_t sample) {
    // The first sample of a waveform has no predecessor, so a seam there has no step.
    if (sample >= std::max<std::int64_t>(next_, 1)) {
        open_.push_back({.begin = sample});
    }
}

void SeamMeter::addSamples(std::span<const float> waveform) {
    for (const float sample : waveform) {
        if (next_ > 0) {
            addDifference(std::abs(sample - last_));
        }
        last_ = sample;
        ++next_;
    }
}

void SeamMeter::addDifference(float difference) {
    bool inSeam = false;
    for (Seam& seam : open_) {
        if (seam.begin <= next_) {
            inSeam = true;
            seams_ += seam.begin == next_ ? 1U : 0U;
            seam.largest = std::max(seam.largest, difference);
        }
    }
    while (!open_.empty() && open_.front().begin + spliceSamples_ <= next_ + 1) {
        largestOfSeams_.add(open_.front().largest);
        open_.pop_front();
    }
    differences_.add(difference);
    const double square = static_cast<double>(difference) * static_cast<double>(difference);
    (inSeam ? seamSquares_ : otherSquares_) += square;
    ++(inSeam ? seamSteps_ : otherSteps_);
}

SeamStatistics SeamMeter::statistics() const {
    SeamStatistics statistics{.seams = seams_};
    if (seams_ > 0) {
        const float percentile = differences_.valueAtShare(0.999);
        std::uint64_t outliers = largestOfSeams_.countAbove(percentile);
        for (const Seam& seam : open_) {
            outliers += seam.begin < next_ && seam.largest > percentile * 1.001F ? 1U : 0U;
        }
        statistics.outlierShare = static_cast<double>(outliers) / static_cast<double>(seams_);
    }
    if (seamSteps_ > 0 && otherSteps_ > 0 && otherSquares_ > 0.0) {
        statistics.jumpRatio = std::sqrt((seamSquares_ / static_cast<double>(seamSteps_)) /
                                         (otherSquares_ / static_cast<double>(otherSteps_)));
    }
    return statistics;
}

}  // namespace haptoflow::engine
