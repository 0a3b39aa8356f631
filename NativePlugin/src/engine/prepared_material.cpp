#include "engine/prepared_material.hpp"

#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

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

// Keeps the logarithm finite.
constexpr float minimumMps2 = 1e-9F;
using inference::levelBatch;
constexpr std::array<float, inference::segmentSamples> silence{};

constexpr float largestDeviation = 2.5F;
// Of a standard normal number that is limited to that. With the density p and the distribution P, its variance is
// 2 P(2.5) - 1 - 5 p(2.5) + 2 * 2.5^2 (1 - P(2.5)).
constexpr double limitedDeviation = 0.988716;
// Voices are numbered from 0.
constexpr std::uint32_t noVoice = std::numeric_limits<std::uint32_t>::max();

// Added to speed and force before taking logarithms, because smaller differences cannot be felt.
constexpr double restMps = 0.002;
constexpr double restNewtons = 0.05;
constexpr double forceShare = 0.5;
constexpr double directionShare = 0.1;

double distance(const Seed& seed, const std::array<float, 3>& motion) {
    const double speed = std::hypot(motion[0], motion[1]);
    const double seedSpeed = std::hypot(seed.velocityMps[0], seed.velocityMps[1]);
    const double speedGap = std::log((speed + restMps) / (seedSpeed + restMps));
    const double forceGap = std::log((motion[2] + restNewtons) / (seed.forceNewtons + restNewtons));
    const double along =
        (seed.velocityMps[0] * motion[0] + seed.velocityMps[1] * motion[1]) / (speed * seedSpeed + restMps * restMps);
    return speedGap * speedGap + forceShare * forceGap * forceGap + directionShare * (1.0 - along * along);
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

const Seed* retrieveSeed(std::span<const Seed> seeds, const std::array<float, 3>& motion) noexcept {
    double nearest = std::numeric_limits<double>::infinity();
    const Seed* chosen = nullptr;
    for (const Seed& seed : seeds) {
        const double gap = distance(seed, motion);
        if (gap < nearest) {
            nearest = gap;
            chosen = &seed;
        }
    }
    return chosen;
}

double PreparedMaterial::logLevel(const std::array<float, 3>& motion) const noexcept {
    const double offset = label->levelOffsetDb * dsp::nepersPerDecibel;
    if (!label->level) {
        return grid->at(*graphLevels, motion) + offset;
    }
    const double own = label->level->logLevel(std::hypot(motion[0], motion[1]), motion[2], label->speedLevelExponent);
    return std::clamp(own + offset, -inference::maximumLogLevel, inference::maximumLogLevel);
}

double PreparedMaterial::forceExponent() const noexcept {
    return label->level ? label->level->forceExponent : label->forceLevelExponent;
}

std::array<float, model::embeddingSize> embeddingOf(const PreparedMaterial& material, ObjectIdentity object) noexcept {
    std::array<float, model::embeddingSize> embedding{};
    std::ranges::copy(material.embedding, embedding.begin());
    const std::size_t pieces = std::min(material.pieceOffsets.size() / model::textureSize, model::maximumPieces);
    if (object.variation == 0.0F || pieces < 2) {
        return embedding;
    }
    std::array<float, model::maximumPieces> numbers{};
    const auto drawn = std::span(numbers).first(pieces);
    skeleton::fillStandardNormal({.seed = object.surfaceSeed, .voice = noVoice}, drawn);
    std::array<double, model::textureSize> offset{};
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const auto number = static_cast<double>(std::clamp(drawn[piece], -largestDeviation, largestDeviation));
        const auto own = material.pieceOffsets.subspan(piece * model::textureSize).first<model::textureSize>();
        for (std::size_t j = 0; j < offset.size(); ++j) {
            offset[j] += number * static_cast<double>(own[j]);
        }
    }
    const double scale =
        static_cast<double>(object.variation) / (limitedDeviation * std::sqrt(static_cast<double>(pieces - 1)));
    for (std::size_t j = 0; j < offset.size(); ++j) {
        embedding[j] = static_cast<float>(static_cast<double>(embedding[j]) + scale * offset[j]);
    }
    return embedding;
}

}  // namespace haptoflow::engine
