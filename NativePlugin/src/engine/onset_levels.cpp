#include "engine/onset_levels.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace haptoflow::engine {
namespace {

constexpr double slowestMps = 0.002;
constexpr double weakestNewtons = 0.02;
constexpr float quietestMps2 = 1e-9F;
constexpr std::size_t batchSize = 256;

/// Where a place on an axis lies between two neighbouring points.
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

constexpr std::array<float, inference::segmentSamples> silence{};

}  // namespace

double OnsetLevels::Axis::value(double place) const noexcept {
    return lowest * std::pow(highest / lowest, place);
}

double OnsetLevels::Axis::place(double value, std::size_t points) const noexcept {
    const double share = std::log(std::clamp(value, lowest, highest) / lowest) / std::log(highest / lowest);
    return share * static_cast<double>(points - 1);
}

OnsetLevels::OnsetLevels(const model::ModelFile& model, inference::SegmentGenerator& generator,
                         const inference::LoadLimits& limits) {
    const model::ModelHeader& header = model.header();
    speed_ = {std::max(slowestMps, header.speedMps.minimum), std::max(2.0 * slowestMps, header.speedMps.maximum)};
    force_ = {std::max(weakestNewtons, header.forceNewtons.minimum),
              std::max(2.0 * weakestNewtons, header.forceNewtons.maximum)};

    std::vector<std::size_t> labelOfTable;
    std::unordered_map<std::size_t, std::size_t> tableOfRow;
    for (std::size_t label = 0; label < header.labels.size(); ++label) {
        const auto [known, isNew] = tableOfRow.emplace(header.labels[label].embeddingRow, labelOfTable.size());
        if (isNew) {
            labelOfTable.push_back(label);
        }
        tables_.push_back(known->second * pointsOfLabel);
    }
    logLevels_.resize(labelOfTable.size() * pointsOfLabel);

    std::vector<inference::SegmentRequest> requests;
    std::vector<float> levels(batchSize);
    for (std::size_t first = 0; first < logLevels_.size(); first += batchSize) {
        limits.check();
        requests.clear();
        for (std::size_t point = first; point < std::min(first + batchSize, logLevels_.size()); ++point) {
            inference::SegmentRequest request{
                .embedding = {}, .motion = motionOf(point % pointsOfLabel), .previous = silence, .noise = silence};
            std::ranges::copy(model.embedding(labelOfTable[point / pointsOfLabel]), request.embedding.begin());
            requests.push_back(request);
        }
        const auto answers = std::span(levels).first(requests.size());
        generator.levels(requests, answers);
        std::ranges::transform(answers, logLevels_.begin() + static_cast<std::ptrdiff_t>(first),
                               [](float level) { return std::log(std::max(level, quietestMps2)); });
    }
}

std::array<float, 3> OnsetLevels::motionOf(std::size_t point) const noexcept {
    const std::size_t force = point % forces;
    const std::size_t direction = point / forces % directions;
    const std::size_t speed = point / (forces * directions);
    const double mps = speed_.value(static_cast<double>(speed) / static_cast<double>(speeds - 1));
    const double newtons = force_.value(static_cast<double>(force) / static_cast<double>(forces - 1));
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(direction) / static_cast<double>(directions);
    return {static_cast<float>(mps * std::cos(angle)), static_cast<float>(mps * std::sin(angle)),
            static_cast<float>(newtons)};
}

double OnsetLevels::logLevel(std::size_t label, const std::array<float, 3>& motion) const noexcept {
    const double turn = std::atan2(motion[1], motion[0]) / (2.0 * std::numbers::pi);
    const double around = (turn < 0.0 ? turn + 1.0 : turn) * static_cast<double>(directions);
    const Between speed = between(speed_.place(std::hypot(motion[0], motion[1]), speeds), speeds);
    const Between direction = betweenAround(around, directions);
    const Between force = between(force_.place(motion[2], forces), forces);
    const auto at = [&](std::size_t s, std::size_t d, std::size_t f) {
        return static_cast<double>(logLevels_[tables_[label] + (s * directions + d) * forces + f]);
    };
    const auto overForce = [&](std::size_t s, std::size_t d) {
        return std::lerp(at(s, d, force.lower), at(s, d, force.upper), force.share);
    };
    const auto overDirection = [&](std::size_t s) {
        return std::lerp(overForce(s, direction.lower), overForce(s, direction.upper), direction.share);
    };
    return std::lerp(overDirection(speed.lower), overDirection(speed.upper), speed.share);
}

float OnsetLevels::at(const MaterialBlend& blend, const std::array<float, 3>& motion) const noexcept {
    if (tables_.empty()) {
        return 0.0F;
    }
    double total = 0.0;
    double sum = 0.0;
    for (std::size_t i = 0; i < std::min(blend.count, MaterialBlend::capacity); ++i) {
        const LabelWeight entry = blend.entries[i];
        if (entry.label < tables_.size() && entry.weight > 0.0F) {
            total += entry.weight;
            sum += entry.weight * logLevel(entry.label, motion);
        }
    }
    return static_cast<float>(std::exp(total > 0.0 ? sum / total : logLevel(0, motion)));
}

}  // namespace haptoflow::engine
