#include "inference/onnx_level_estimator.hpp"

#include "inference/level_rules.hpp"
#include "inference/tier_graphs.hpp"

#include <algorithm>
#include <utility>

namespace haptoflow::inference {

OnnxLevelEstimator::OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                       const model::Tier& tier, const LoadLimits& limits)
    : graph_(loadLevel(std::move(runtime), model, tier, levelBatch, limits)) {}

void OnnxLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    requireRoomForLevels(requests, levelsMps2);
    for (std::size_t first = 0; first < requests.size(); first += levelBatch) {
        const std::size_t count = std::min(levelBatch, requests.size() - first);
        estimate(requests.subspan(first, count), levelsMps2.subspan(first, count));
    }
}

void OnnxLevelEstimator::estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    if (std::ranges::all_of(requests, [](const SegmentRequest& each) { return each.levelMps2.has_value(); })) {
        std::ranges::transform(requests, levelsMps2.begin(),
                               [](const SegmentRequest& each) { return *each.levelMps2; });
        return;
    }
    graph_.setBatch(requests.size());
    const auto embeddings = graph_.input(level_input::embedding);
    const auto motions = graph_.input(level_input::motion);
    for (std::size_t index = 0; index < requests.size(); ++index) {
        std::ranges::copy(requests[index].embedding, embeddings.subspan(index * embeddingSize).begin());
        std::ranges::copy(levelMotionOf(requests[index]), motions.subspan(index * 3).begin());
    }
    graph_.run();
    for (std::size_t index = 0; index < requests.size(); ++index) {
        const SegmentRequest& request = requests[index];
        levelsMps2[index] =
            request.levelMps2 ? *request.levelMps2 : levelOf(request, graph_.output()[index], "level graph");
    }
}

}  // namespace haptoflow::inference
