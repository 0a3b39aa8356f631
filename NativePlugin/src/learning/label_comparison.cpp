#include "learning/label_comparison.hpp"

#include "learning/texture_figures.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace haptoflow::learning {
namespace {

/// A level this far from those of all labels is probably in another unit.
constexpr double suspiciousLevelDb = 30.0;

struct Spread {
    double mean = 0.0;
    double deviation = 0.0;
};

Spread spreadOf(const std::vector<model::Label>& labels, double model::Label::*exponent) {
    const auto count = static_cast<double>(labels.size());
    double mean = 0.0;
    for (const model::Label& label : labels) {
        mean += label.*exponent / count;
    }
    double squares = 0.0;
    for (const model::Label& label : labels) {
        squares += (label.*exponent - mean) * (label.*exponent - mean);
    }
    return {.mean = mean, .deviation = std::clamp(std::sqrt(squares / count), 0.05, 0.5)};
}

}  // namespace

ExponentPrior exponentPrior(const model::ModelHeader& model) {
    if (model.labels.size() < 3) {
        return {};
    }
    const Spread speed = spreadOf(model.labels, &model::Label::speedLevelExponent);
    const Spread force = spreadOf(model.labels, &model::Label::forceLevelExponent);
    return {.speedMean = speed.mean,
            .speedSpread = speed.deviation,
            .forceMean = force.mean,
            .forceSpread = force.deviation};
}

std::vector<float> levelsOf(inference::SegmentGenerator& generator, std::span<const LevelCondition> conditions) {
    const std::array<float, inference::segmentSamples> silence{};
    std::vector<inference::SegmentRequest> requests;
    for (const LevelCondition& each : conditions) {
        requests.push_back({.embedding = each.embedding,
                            .motion = {static_cast<float>(each.speedMps), 0.0F, static_cast<float>(each.forceNewtons)},
                            .previous = silence,
                            .noise = silence});
    }
    std::vector<float> levels(requests.size());
    generator.levels(requests, levels);
    return levels;
}

void requireOwnLevels(const model::ModelFile& model, inference::SegmentGenerator& generator) {
    const model::ModelHeader& header = model.header();
    std::vector<LevelCondition> conditions;
    for (std::size_t label = 0; label < header.labels.size(); ++label) {
        for (const double share : {0.25, 0.75}) {
            conditions.push_back({{}, header.speedMps.at(share), header.forceNewtons.at(share)});
            std::ranges::copy(model.embedding(label), conditions.back().embedding.begin());
        }
    }
    const std::vector<float> levels = levelsOf(generator, conditions);
    const auto [least, greatest] = std::ranges::minmax(levels);
    if (greatest - least <= 1e-4F * greatest) {
        throw std::invalid_argument("the model gives all its labels one level, " + recordings::plainNumber(greatest) +
                                    " m/s^2: its networks have a unit of their own, in which no recording's level can "
                                    "be stated; learn with another model, or one distilled from this");
    }
}

std::optional<std::string> levelWarning(const LevelLaw& level, const Sliding& sliding, const model::ModelFile& model,
                                        inference::SegmentGenerator& generator) {
    using recordings::plainNumber;
    const model::ModelHeader& header = model.header();
    const double speed = std::min(sliding.speedMps[1], header.speedMps.maximum);
    const double force = std::clamp(sliding.forceNewtons[1], header.forceNewtons.minimum, header.forceNewtons.maximum);
    std::vector<LevelCondition> conditions(header.labels.size(), {{}, speed, force});
    for (std::size_t label = 0; label < conditions.size(); ++label) {
        std::ranges::copy(model.embedding(label), conditions[label].embedding.begin());
    }
    const std::vector<float> levels = levelsOf(generator, conditions);
    const auto [quietest, loudest] = std::ranges::minmax(levels);
    const double own = std::exp(level.logLevel(speed, force));
    const double belowDb = decibelsPerNat * std::log(quietest / own);
    const double aboveDb = decibelsPerNat * std::log(own / loudest);
    if (belowDb <= suspiciousLevelDb && aboveDb <= suspiciousLevelDb) {
        return std::nullopt;
    }
    std::string warning = "the level, " + plainNumber(own) + " m/s^2 RMS at " + plainNumber(1000.0 * speed) +
                          " mm/s, is " + plainNumber(std::max(belowDb, aboveDb)) + " dB " +
                          (belowDb > 0.0 ? "below" : "above") + " every label of the model (" + plainNumber(quietest) +
                          " to " + plainNumber(loudest) + " m/s^2); check the unit or full scale of the acceleration";
    if (belowDb > 2.0 * suspiciousLevelDb || aboveDb > 2.0 * suspiciousLevelDb) {
        throw recordings::RecordingUnusable(warning);
    }
    return warning;
}

}  // namespace haptoflow::learning
