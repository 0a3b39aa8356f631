#include "engine/onset_levels.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace haptoflow::engine {
namespace {

// Keeps the logarithm finite.
constexpr float minimumMps2 = 1e-9F;
using inference::levelBatch;
constexpr std::array<float, inference::segmentSamples> silence{};

}  // namespace

std::vector<float> tabulateLevels(const LevelGrid& grid,
                                  std::span<const std::span<const float, model::embeddingSize>> embeddings,
                                  inference::LevelEstimator& estimator, const inference::LoadLimits& limits) {
    std::vector<float> logLevels(embeddings.size() * LevelGrid::points);
    std::vector<inference::SegmentRequest> requests;
    std::vector<float> levels(levelBatch);
    for (std::size_t first = 0; first < logLevels.size(); first += levelBatch) {
        limits.check();
        requests.clear();
        for (std::size_t point = first; point < std::min(first + levelBatch, logLevels.size()); ++point) {
            inference::SegmentRequest request{.embedding = {},
                                              .motion = grid.motionOf(point % LevelGrid::points),
                                              .previous = silence,
                                              .noise = silence};
            std::ranges::copy(embeddings[point / LevelGrid::points], request.embedding.begin());
            requests.push_back(request);
        }
        const auto answers = std::span(levels).first(requests.size());
        estimator.levels(requests, answers);
        std::ranges::transform(answers, logLevels.begin() + static_cast<std::ptrdiff_t>(first),
                               [](float level) { return std::log(std::max(level, minimumMps2)); });
    }
    return logLevels;
}

OnsetLevels::OnsetLevels(const model::ModelFile& model, inference::LevelEstimator& estimator,
                         const inference::LoadLimits& limits)
    : grid_(model.header()) {
    std::vector<std::span<const float, model::embeddingSize>> embeddings;
    std::unordered_map<std::size_t, std::size_t> tableOfRow;
    const auto& labels = model.header().labels;
    for (std::size_t label = 0; label < labels.size(); ++label) {
        const auto [known, isNew] = tableOfRow.emplace(labels[label].embeddingRow, embeddings.size());
        if (isNew) {
            embeddings.push_back(model.embedding(label));
        }
        tables_.push_back(known->second * LevelGrid::points);
    }
    logLevels_ = tabulateLevels(grid_, embeddings, estimator, limits);
}

LevelGrid::Table OnsetLevels::table(std::size_t label) const noexcept {
    return std::span(logLevels_).subspan(tables_[label]).first<LevelGrid::points>();
}

}  // namespace haptoflow::engine
