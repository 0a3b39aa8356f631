#include "bench/watched_generators.hpp"

#include <algorithm>

namespace haptoflow::bench {

void MarkingGenerator::generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) {
    behind_->generate(requests, segments);
    for (std::size_t index = 0; index < requests.size(); ++index) {
        const auto segment = segments.subspan(index * inference::segmentSamples, inference::segmentSamples);
        const std::size_t label = model_.nearestLabel(requests[index].embedding);
        const auto place = std::ranges::find(labels_, label) - labels_.begin();
        std::ranges::fill(segment, markMps2(static_cast<std::size_t>(place)));
    }
}

}  // namespace haptoflow::bench
