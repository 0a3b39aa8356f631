#include "engine/value_histogram.hpp"

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

}  // namespace haptoflow::engine
