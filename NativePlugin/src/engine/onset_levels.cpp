#include "engine/onset_levels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace haptoflow::engine {
namespace {

constexpr double slowestMps = 0.002;
constexpr double weakestNewtons = 0.02;

/// Position between two neighbouring points of an axis.
struct Between {
    std::size_t lower;
    std::size_t upper;
    double share;
};

Between between(double place, std::size_t points) noexcept {
    const auto lower = std::min(static_cast<std::size_t>(place), points - 2);
    return {lower, lower + 1, place - static_cast<double>(lower)};
}

Between betweenAround(double place, std::size_t points) noexcept {
    const auto lower = static_cast<std::size_t>(place) % points;
    return {lower, (lower + 1) % points, place - std::floor(place)};
}

}  // namespace

double LevelGrid::Axis::value(double place) const noexcept {
    return lowest * std::pow(highest / lowest, place);
}

double LevelGrid::Axis::place(double value, std::size_t count) const noexcept {
    const double share = std::log(std::clamp(value, lowest, highest) / lowest) / std::log(highest / lowest);
    return share * static_cast<double>(count - 1);
}

LevelGrid::LevelGrid(const model::ModelHeader& header) noexcept
    : speed_{std::max(slowestMps, header.speedMps.minimum), std::max(2.0 * slowestMps, header.speedMps.maximum)},
      force_{std::max(weakestNewtons, header.forceNewtons.minimum),
             std::max(2.0 * weakestNewtons, header.forceNewtons.maximum)} {}

std::array<float, 3> LevelGrid::motionOf(std::size_t point) const noexcept {
    const std::size_t force = point % forces;
    const std::size_t direction = point / forces % directions;
    const std::size_t speed = point / (forces * directions);
    const double mps = speed_.value(static_cast<double>(speed) / static_cast<double>(speeds - 1));
    const double newtons = force_.value(static_cast<double>(force) / static_cast<double>(forces - 1));
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(direction) / static_cast<double>(directions);
    return {static_cast<float>(mps * std::cos(angle)), static_cast<float>(mps * std::sin(angle)),
            static_cast<float>(newtons)};
}

double LevelGrid::at(Table table, const std::array<float, 3>& motion) const noexcept {
    const double turn = std::atan2(motion[1], motion[0]) / (2.0 * std::numbers::pi);
    const double around = (turn < 0.0 ? turn + 1.0 : turn) * static_cast<double>(directions);
    const Between speed = between(speed_.place(std::hypot(motion[0], motion[1]), speeds), speeds);
    const Between direction = betweenAround(around, directions);
    const Between force = between(force_.place(motion[2], forces), forces);
    const auto at = [&](std::size_t s, std::size_t d, std::size_t f) {
        return static_cast<double>(table[(s * directions + d) * forces + f]);
    };
    const auto overForce = [&](std::size_t s, std::size_t d) {
        return std::lerp(at(s, d, force.lower), at(s, d, force.upper), force.share);
    };
    const auto overDirection = [&](std::size_t s) {
        return std::lerp(overForce(s, direction.lower), overForce(s, direction.upper), direction.share);
    };
    return std::lerp(overDirection(speed.lower), overDirection(speed.upper), speed.share);
}

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
