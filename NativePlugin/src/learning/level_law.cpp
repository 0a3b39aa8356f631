#include "learning/level_law.hpp"

#include "learning/numerics.hpp"
#include "learning/texture_figures.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace haptoflow::learning {
namespace {

constexpr std::size_t frameSamples = 100;
constexpr std::size_t frameHop = 50;
/// Standard deviations: of one frame's log RMS from the law, and of a slope between knots from the common one.
constexpr double frameSpread = 0.35;
constexpr double slopeSpread = 0.45;
constexpr double framesPerKnot = 14.0;
constexpr double knotDistance = 0.22;
constexpr std::size_t maximumKnots = 14;
constexpr int newtonRounds = 30;

struct Frame {
    double logSpeed = 0.0;
    double logForce = 0.0;
    double power = 0.0;
};

std::vector<Frame> framesOf(const recordings::PreparedRecording& recording, const Sliding& sliding) {
    std::vector<Frame> frames;
    for (std::size_t start = 0; start + frameSamples <= recording.wave.size(); start += frameHop) {
        if (!sliding.holds(start, frameSamples)) {
            continue;
        }
        Frame frame;
        double squaredSpeed = 0.0;
        for (std::size_t i = start; i < start + frameSamples; ++i) {
            const double value = recording.wave[i];
            const double speed = recording.speedMps(i) + model::LevelTable::restMps;
            frame.power += value * value / static_cast<double>(frameSamples);
            squaredSpeed += speed * speed / static_cast<double>(frameSamples);
            frame.logForce += std::log(std::max(static_cast<double>(recording.motion[i][2]),
                                                model::LevelTable::minimumForceNewtons)) /
                              static_cast<double>(frameSamples);
        }
        // Levels grow about in proportion to the speed, so that a frame's mean power corresponds to the mean square of
        // its speed.
        frame.logSpeed = 0.5 * std::log(squaredSpeed);
        // Avoids the logarithm of digital silence: the limit is a hundredth of the detection threshold.
        frame.power = std::max(frame.power, 1e-10);
        frames.push_back(frame);
    }
    return frames;
}

/// Log speeds of the knots: evenly spaced quantiles with a minimum distance that the frames can resolve.
std::vector<double> knotsOf(const std::vector<Frame>& frames) {
    std::vector<double> sorted(frames.size());
    std::ranges::transform(frames, sorted.begin(), [](const Frame& frame) { return frame.logSpeed; });
    std::ranges::sort(sorted);
    const auto quantile = [&](double share) {
        return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
    };
    const double first = quantile(0.03);
    const double last = quantile(0.97);
    if (last - first < knotDistance) {
        return {quantile(0.5)};
    }
    const auto count = std::clamp<std::size_t>(
        1 + static_cast<std::size_t>(static_cast<double>(frames.size()) / framesPerKnot), 2, maximumKnots);
    std::vector<double> knots{first};
    for (std::size_t i = 1; i + 1 < count; ++i) {
        const double knot = quantile(0.03 + 0.94 * static_cast<double>(i) / static_cast<double>(count - 1));
        if (knot - knots.back() >= knotDistance && last - knot >= knotDistance) {
            knots.push_back(knot);
        }
    }
    knots.push_back(last);
    return knots;
}

/// The unknowns: the log level at each knot, then the common slope, then the force exponent.
class Fit {
public:
    Fit(const std::vector<Frame>& frames, std::vector<double> knots, double logForce, const ExponentPrior& prior)
        : frames_(frames), knots_(std::move(knots)), logForce_(logForce), prior_(prior) {}

    std::vector<double> solve() {
        double mean = 0.0;
        for (const Frame& frame : frames_) {
            mean += 0.5 * std::log(frame.power) / static_cast<double>(frames_.size());
        }
        std::vector<double> unknown(knots_.size() + 2, mean);
        unknown[slope()] = prior_.speedMean;
        unknown[force()] = prior_.forceMean;
        for (int round = 0; round < newtonRounds; ++round) {
            step(unknown);
        }
        return unknown;
    }

private:
    [[nodiscard]] std::size_t slope() const { return knots_.size(); }
    [[nodiscard]] std::size_t force() const { return knots_.size() + 1; }

    struct Row {
        std::array<std::size_t, 4> index{};
        std::array<double, 4> factor{};
        std::size_t count = 0;

        void add(std::size_t at, double value) {
            index[count] = at;
            factor[count] = value;
            ++count;
        }
    };

    [[nodiscard]] Row rowOf(const Frame& frame) const {
        Row row;
        const std::size_t last = knots_.size() - 1;
        if (frame.logSpeed <= knots_.front() || last == 0) {
            row.add(0, 1.0);
            row.add(slope(), frame.logSpeed - knots_.front());
        } else if (frame.logSpeed >= knots_.back()) {
            row.add(last, 1.0);
            row.add(slope(), frame.logSpeed - knots_.back());
        } else {
            const auto above =
                static_cast<std::size_t>(std::ranges::upper_bound(knots_, frame.logSpeed) - knots_.begin());
            const double share = (frame.logSpeed - knots_[above - 1]) / (knots_[above] - knots_[above - 1]);
            row.add(above - 1, 1.0 - share);
            row.add(above, share);
        }
        row.add(force(), frame.logForce - logForce_);
        return row;
    }

    static void accumulate(SymmetricMatrix& normal, std::vector<double>& right, const Row& row, double residual,
                           double weight) {
        for (std::size_t i = 0; i < row.count; ++i) {
            right[row.index[i]] += weight * row.factor[i] * residual;
            for (std::size_t j = 0; j < row.count; ++j) {
                normal.at(row.index[i], row.index[j]) += weight * row.factor[i] * row.factor[j];
            }
        }
    }

    /// One step of Fisher scoring for s + power exp(-2 s) / 2, whose derivative is 1 - power exp(-2 s) and whose
    /// expected second derivative is 2. Frames overlap by half.
    void step(std::vector<double>& unknown) const {
        SymmetricMatrix normal(unknown.size());
        std::vector<double> right(unknown.size());
        // Fifty milliseconds of a low rumble may have nine times the law's power by chance; more is a knock.
        constexpr double largestStep = 4.0;
        constexpr double frameWeight = 0.5 / (frameSpread * frameSpread);
        for (const Frame& frame : frames_) {
            const Row row = rowOf(frame);
            double law = 0.0;
            for (std::size_t i = 0; i < row.count; ++i) {
                law += row.factor[i] * unknown[row.index[i]];
            }
            const double excess = frame.power * std::exp(-2.0 * law) - 1.0;
            accumulate(normal, right, row, std::clamp(0.5 * excess, -largestStep, largestStep), frameWeight);
        }
        for (std::size_t i = 1; i < knots_.size(); ++i) {
            const double distance = knots_[i] - knots_[i - 1];
            Row row;
            row.add(i, 1.0);
            row.add(i - 1, -1.0);
            row.add(slope(), -distance);
            const double residual = -(unknown[i] - unknown[i - 1] - distance * unknown[slope()]);
            // The slope may change as much within one wide interval as within several narrow ones.
            accumulate(normal, right, row, residual, 1.0 / (slopeSpread * slopeSpread * distance * knotDistance));
        }
        const auto towards = [&](std::size_t index, double mean, double spread) {
            Row row;
            row.add(index, 1.0);
            accumulate(normal, right, row, mean - unknown[index], 1.0 / (spread * spread));
        };
        towards(slope(), prior_.speedMean, prior_.speedSpread);
        towards(force(), prior_.forceMean, prior_.forceSpread);
        const std::vector<double> change = solvePositive(normal, std::move(right));
        for (std::size_t i = 0; i < unknown.size(); ++i) {
            unknown[i] += std::clamp(change[i], -2.0, 2.0);
        }
    }

    const std::vector<Frame>& frames_;
    std::vector<double> knots_;
    double logForce_;
    ExponentPrior prior_;
};

/// The slope from one end of the table to the other, weighted against the prior by the table's width.
double overallSlope(const std::vector<double>& knots, const std::vector<double>& logLevels,
                    const ExponentPrior& prior) {
    constexpr double endSpread = 0.15;
    const double width = knots.back() - knots.front();
    if (width <= 0.0) {
        return prior.speedMean;
    }
    const double slope = (logLevels[knots.size() - 1] - logLevels[0]) / width;
    const double trust = width * width / (endSpread * endSpread);
    const double priorTrust = 1.0 / (prior.speedSpread * prior.speedSpread);
    return (trust * slope + priorTrust * prior.speedMean) / (trust + priorTrust);
}

}  // namespace

LevelLaw fitLevelLaw(const recordings::PreparedRecording& recording, const Sliding& sliding,
                     const ExponentPrior& prior) {
    const std::vector<Frame> frames = framesOf(recording, sliding);
    if (frames.size() < 10) {
        throw recordings::RecordingUnusable(
            "the strokes are too short: hardly any slides for 50 ms at a stretch; record longer "
            "strokes");
    }
    LevelLaw law;
    law.table.forceNewtons = std::clamp(sliding.forceNewtons[1], 0.01, 100.0);
    const std::vector<double> knots = knotsOf(frames);
    std::vector<double> unknown = Fit(frames, knots, std::log(law.table.forceNewtons), prior).solve();
    law.table.forceExponent =
        std::clamp(unknown[knots.size() + 1], -model::maximumLevelExponent, model::maximumLevelExponent);
    law.speedExponent =
        std::clamp(overallSlope(knots, unknown, prior), -model::maximumLevelExponent, model::maximumLevelExponent);
    for (std::size_t i = 0; i < knots.size(); ++i) {
        law.table.speedsMps.push_back(std::exp(knots[i]) - model::LevelTable::restMps);
        law.table.logLevels.push_back(unknown[i]);
    }
    return law;
}

namespace {

constexpr double slowestMps = 0.02;
constexpr double fastestMps = 0.3;
constexpr double lightestNewtons = 0.3;
constexpr double firmestNewtons = 2.0;
/// Uncertainty that is worth another recording.
constexpr double noticeableDb = 1.0;
/// Below this, chance in the frames limits the tone.
constexpr double enoughSeconds = 20.0;

struct Gap {
    double uncertaintyDb = 0.0;
    std::string sentence;
};

std::string millimetres(double metres) {
    return recordings::plainNumber(std::round(1000.0 * metres));
}

std::string newtons(double force) {
    return recordings::plainNumber(std::round(100.0 * force) / 100.0);
}

}  // namespace

std::string recordNext(const Sliding& sliding, const ExponentPrior& prior) {
    const auto [slow, usual, fast] = sliding.speedMps;
    const auto [light, medium, firm] = sliding.forceNewtons;
    const auto uncertainty = [](double spread, double ratio) { return decibelsPerNat * spread * std::log(ratio); };
    const std::array<Gap, 4> gaps{{
        {uncertainty(prior.speedSpread, fastestMps / fast), "record faster strokes, up to " + millimetres(fastestMps) +
                                                                " mm/s: above " + millimetres(fast) +
                                                                " mm/s the material is a guess"},
        {uncertainty(prior.speedSpread, slow / slowestMps), "record slower strokes, down to " +
                                                                millimetres(slowestMps) + " mm/s: below " +
                                                                millimetres(slow) + " mm/s the material is a guess"},
        {uncertainty(prior.forceSpread, firmestNewtons / firm), "press harder, up to " + newtons(firmestNewtons) +
                                                                    " N: above " + newtons(firm) +
                                                                    " N the material is a guess"},
        {uncertainty(prior.forceSpread, light / lightestNewtons), "press less, down to " + newtons(lightestNewtons) +
                                                                      " N: below " + newtons(light) +
                                                                      " N the material is a guess"},
    }};
    const Gap& widest = *std::ranges::max_element(gaps, {}, &Gap::uncertaintyDb);
    if (widest.uncertaintyDb >= noticeableDb) {
        return widest.sentence;
    }
    if (sliding.seconds < enoughSeconds) {
        return "record more of the same: " + recordings::plainNumber(enoughSeconds) +
               " s of sliding or more give a finer tone";
    }
    return {};
}

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
