#include "bench/watched_generators.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace haptoflow::bench {

MarkingGenerator::MarkingGenerator(std::unique_ptr<inference::SegmentGenerator> behind, const model::ModelFile& model,
                                   std::span<const std::uint32_t> labels)
    : behind_(std::move(behind)) {
    for (const std::uint32_t label : labels) {
        std::ranges::copy(model.embedding(label), embeddings_.emplace_back().begin());
    }
}

void MarkingGenerator::generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) {
    behind_->generate(requests, segments);
    for (std::size_t index = 0; index < requests.size(); ++index) {
        const auto segment = segments.subspan(index * inference::segmentSamples, inference::segmentSamples);
        std::ranges::fill(segment, markMps2(placeOf(requests[index].embedding)));
    }
}

std::size_t MarkingGenerator::placeOf(const std::array<float, inference::embeddingSize>& embedding) const {
    std::size_t nearest = 0;
    float smallest = std::numeric_limits<float>::max();
    for (std::size_t place = 0; place < embeddings_.size(); ++place) {
        float distance = 0.0F;
        for (std::size_t i = 0; i < embedding.size(); ++i) {
            const float difference = embedding[i] - embeddings_[place][i];
            distance += difference * difference;
        }
        if (distance < smallest) {
            smallest = distance;
            nearest = place;
        }
    }
    return nearest;
}

}  // namespace haptoflow::bench
