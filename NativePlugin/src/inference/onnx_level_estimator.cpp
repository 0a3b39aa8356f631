#include "inference/onnx_level_estimator.hpp"

#include "inference/inference_error.hpp"
#include "inference/tier_graphs.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::inference {

OnnxLevelEstimator::OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model,
                                       const model::Tier& tier, const LoadLimits& limits)
    : graph_(loadLevel(std::move(runtime), model, tier, levelBatch, limits)) {}

void OnnxLevelEstimator::levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) {
    if (levelsMps2.size() != requests.size()) {
        throw std::invalid_argument("levels need room for " + std::to_string(requests.size()) + " numbers, not " +
                                    std::to_string(levelsMps2.size()));
    }
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
        std::ranges::copy(requests[index].levelMotion.value_or(requests[index].motion),
                          motions.subspan(index * 3).begin());
    }
    graph_.run();
    for (std::size_t index = 0; index < requests.size(); ++index) {
        if (requests[index].levelMps2) {
            levelsMps2[index] = *requests[index].levelMps2;
            continue;
        }
        const float logLevel = graph_.output()[index];
        if (!std::isfinite(logLevel) || logLevel > static_cast<float>(maximumLogLevel)) {
            throw InferenceError("the level graph returned a logarithm of " + std::to_string(logLevel) +
                                 "; expected a number up to 20");
        }
        // Lower levels cannot be felt, and dividing the previous waveform by them would overflow.
        levelsMps2[index] =
            std::exp(std::max(logLevel, static_cast<float>(-maximumLogLevel))) * requests[index].levelGain;
    }
}

}  // namespace haptoflow::inference
