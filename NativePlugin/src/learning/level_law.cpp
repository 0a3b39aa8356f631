#include "learning/level_law.hpp"

#include "learning/linear_algebra.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

/// Standard deviation of the log speed in a frame above which the tracker's smoothed speed does not match the wave.
constexpr double maximumUnsteadiness = 0.6;
constexpr double knotsPerNat = 2.2;
constexpr std::size_t maximumKnots = 16;
constexpr std::size_t framesPerKnot = 6;
constexpr double narrowestTable = 0.05;
/// Standard deviations: of one frame's log level from the law, and of the change of slope over one unit of log speed.
constexpr double frameSpread = 0.2;
constexpr double bendSpread = 0.35;
/// Frames overlap by half.
constexpr double frameWeight = 0.5 / (frameSpread * frameSpread);
constexpr int rounds = 40;
constexpr std::size_t fewestFrames = 10;

double unsteadiness(std::span<const std::array<float, 3>> motion) {
    constexpr double restMps = 0.002;
    double sum = 0.0;
    double squares = 0.0;
    for (const auto& each : motion) {
        const double value = std::log(std::hypot(each[0], each[1]) + restMps);
        sum += value;
        squares += value * value;
    }
    const double mean = sum / static_cast<double>(motion.size());
    return std::sqrt(std::max(squares / static_cast<double>(motion.size()) - mean * mean, 0.0));
}

std::vector<LevelFrame> framesOf(const recordings::PreparedRecording& recording, const Sliding& sliding,
                                 std::size_t length) {
    std::vector<LevelFrame> all;
    std::vector<LevelFrame> steady;
    for (std::size_t start = 0; start + length <= recording.wave.size(); start += length / 2) {
        if (sliding.holds(start, length)) {
            const auto motion = std::span(recording.motion).subspan(start, length);
            all.push_back(levelFrame(std::span(recording.wave).subspan(start, length), motion));
            if (unsteadiness(motion) < maximumUnsteadiness) {
                steady.push_back(all.back());
            }
        }
    }
    return steady.size() >= fewestFrames ? steady : all;
}

double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(place);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Log speeds of the knots, evenly spaced over the recorded speeds.
std::vector<double> knotsOf(std::span<const LevelFrame> frames) {
    std::vector<double> sorted(frames.size());
    std::ranges::transform(frames, sorted.begin(), &LevelFrame::logSpeed);
    std::ranges::sort(sorted);
    const double first = quantile(sorted, 0.02);
    const double last = quantile(sorted, 0.98);
    const auto wanted = static_cast<std::size_t>(1 + std::lround(knotsPerNat * (last - first)));
    const std::size_t count = std::min({wanted, maximumKnots, std::max<std::size_t>(1, frames.size() / framesPerKnot)});
    if (count == 1 || last - first < narrowestTable) {
        return {quantile(sorted, 0.5)};
    }
    std::vector<double> knots(count);
    for (std::size_t i = 0; i < count; ++i) {
        knots[i] = first + (last - first) * static_cast<double>(i) / static_cast<double>(count - 1);
    }
    return knots;
}

/// A sum of unknowns, each with a factor.
struct Row {
    std::array<std::size_t, 3> index{};
    std::array<double, 3> factor{};
    std::size_t count = 0;

    void add(std::size_t at, double value) {
        index[count] = at;
        factor[count] = value;
        ++count;
    }

    [[nodiscard]] double of(const std::vector<double>& unknown) const {
        double sum = 0.0;
        for (std::size_t i = 0; i < count; ++i) {
            sum += factor[i] * unknown[index[i]];
        }
        return sum;
    }
};

struct NormalEquations {
    explicit NormalEquations(std::size_t unknowns) : matrix(unknowns), right(unknowns) {}

    void add(const Row& row, double wanted, double weight) {
        for (std::size_t i = 0; i < row.count; ++i) {
            right[row.index[i]] += weight * row.factor[i] * wanted;
            for (std::size_t j = 0; j < row.count; ++j) {
                matrix.at(row.index[i], row.index[j]) += weight * row.factor[i] * row.factor[j];
            }
        }
    }

    SymmetricMatrix matrix;
    std::vector<double> right;
};

/// The log level at a speed as a sum of the knots' levels, constant beyond the ends.
Row levelAt(const std::vector<double>& knots, double logSpeed) {
    Row row;
    const double inside = std::clamp(logSpeed, knots.front(), knots.back());
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(knots, inside) - knots.begin());
    if (above == 0 || above == knots.size()) {
        row.add(above == 0 ? 0 : knots.size() - 1, 1.0);
        return row;
    }
    const double share = (inside - knots[above - 1]) / (knots[above] - knots[above - 1]);
    row.add(above - 1, 1.0 - share);
    row.add(above, share);
    return row;
}

/// Slopes about the prior's, changes of slope about zero, the exponent of the force about the prior's.
void addPrior(NormalEquations& equations, const std::vector<double>& knots, const ExponentPrior& prior) {
    const auto precision = [](double spread) { return 1.0 / (spread * spread); };
    for (std::size_t i = 1; i < knots.size(); ++i) {
        const double step = knots[i] - knots[i - 1];
        Row slope;
        slope.add(i - 1, -1.0 / step);
        slope.add(i, 1.0 / step);
        equations.add(slope, prior.speedMean, precision(3.0 * prior.speedSpread));
        if (i + 1 < knots.size()) {
            const double next = knots[i + 1] - knots[i];
            Row bend;
            bend.add(i - 1, 1.0 / step);
            bend.add(i, -1.0 / step - 1.0 / next);
            bend.add(i + 1, 1.0 / next);
            equations.add(bend, 0.0, precision(bendSpread * std::sqrt(2.0 * step)));
        }
    }
    Row force;
    force.add(knots.size(), 1.0);
    equations.add(force, prior.forceMean, precision(prior.forceSpread));
}

/// Fisher scoring of the log levels at the knots and, last, the exponent of the force.
std::vector<double> solve(std::span<const LevelFrame> frames, const std::vector<double>& knots, double logForce,
                          const ExponentPrior& prior) {
    std::vector<Row> rows;
    double mean = 0.0;
    for (const LevelFrame& frame : frames) {
        rows.push_back(levelAt(knots, frame.logSpeed));
        rows.back().add(knots.size(), frame.logForce - logForce);
        mean += 0.5 * std::log(frame.power) / static_cast<double>(frames.size());
    }
    std::vector<double> unknown(knots.size() + 1, mean);
    unknown.back() = prior.forceMean;
    for (int round = 0; round < rounds; ++round) {
        NormalEquations equations(unknown.size());
        addPrior(equations, knots, prior);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const double law = rows[i].of(unknown);
            // Limited, so that a single impact cannot destabilise the first rounds.
            const double step = std::clamp(0.5 * (frames[i].power * std::exp(-2.0 * law) - 1.0), -1.0, 2.0);
            equations.add(rows[i], law + step, frameWeight);
        }
        unknown = solvePositive(std::move(equations.matrix), std::move(equations.right));
    }
    return unknown;
}

/// The slope over the faster half of the frames, from which the law is continued; the prior's where data are scarce.
double slopeBeyond(std::span<const LevelFrame> frames, const std::vector<double>& knots,
                   const std::vector<double>& unknown, const ExponentPrior& prior) {
    std::vector<double> sorted(frames.size());
    std::ranges::transform(frames, sorted.begin(), &LevelFrame::logSpeed);
    std::ranges::sort(sorted);
    const double median = quantile(sorted, 0.5);
    const auto faster = static_cast<std::size_t>(std::ranges::lower_bound(sorted, median) - sorted.begin());
    const auto count = static_cast<double>(sorted.size() - faster);
    double meanSpeed = 0.0;
    for (std::size_t i = faster; i < sorted.size(); ++i) {
        meanSpeed += sorted[i] / count;
    }
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = faster; i < sorted.size(); ++i) {
        squares += (sorted[i] - meanSpeed) * (sorted[i] - meanSpeed);
        products += (sorted[i] - meanSpeed) * levelAt(knots, sorted[i]).of(unknown);
    }
    const double certainty = frameWeight * squares;
    const double priorCertainty = 1.0 / (prior.speedSpread * prior.speedSpread);
    const double slope = products / std::max(squares, 1e-9);
    return std::clamp((certainty * slope + priorCertainty * prior.speedMean) / (certainty + priorCertainty), 0.0, 2.0);
}

}  // namespace

LevelFrame levelFrame(std::span<const float> wave, std::span<const std::array<float, 3>> motion) {
    const auto count = static_cast<double>(wave.size());
    double speed = 0.0;
    double force = 0.0;
    double power = 0.0;
    for (std::size_t i = 0; i < wave.size(); ++i) {
        speed += std::hypot(motion[i][0], motion[i][1]) / count;
        force += motion[i][2] / count;
        power += static_cast<double>(wave[i]) * wave[i] / count;
    }
    // Avoids the logarithm of digital silence: the limit is a hundredth of the detection threshold.
    constexpr double silentPower = 1e-10;
    return {.logSpeed = std::log(speed + model::LevelTable::restMps),
            .logForce = std::log(std::max(force, model::LevelTable::minimumForceNewtons)),
            .power = std::max(power, silentPower)};
}

LevelLaw fitLevelLaw(std::span<const LevelFrame> frames, const ExponentPrior& prior) {
    double logForce = 0.0;
    for (const LevelFrame& frame : frames) {
        logForce += frame.logForce / static_cast<double>(frames.size());
    }
    const std::vector<double> knots = knotsOf(frames);
    const std::vector<double> unknown = solve(frames, knots, logForce, prior);
    LevelLaw law;
    law.table.forceNewtons = std::exp(logForce);
    law.table.forceExponent = std::clamp(unknown.back(), -model::maximumLevelExponent, model::maximumLevelExponent);
    law.speedExponent = slopeBeyond(frames, knots, unknown, prior);
    for (std::size_t i = 0; i < knots.size(); ++i) {
        law.table.speedsMps.push_back(std::max(std::exp(knots[i]) - model::LevelTable::restMps, 0.0));
        law.table.logLevels.push_back(unknown[i]);
    }
    return law;
}

LevelLaw fitLevelLaw(const recordings::PreparedRecording& recording, const Sliding& sliding,
                     const ExponentPrior& prior) {
    std::vector<LevelFrame> frames = framesOf(recording, sliding, levelFrameSamples);
    if (frames.size() < fewestFrames) {
        frames = framesOf(recording, sliding, levelFrameSamples / 2);
    }
    if (frames.size() < fewestFrames) {
        throw recordings::RecordingUnusable(
            "the strokes are too short: hardly any slides for 50 ms at a stretch; record longer "
            "strokes");
    }
    return fitLevelLaw(frames, prior);
}

}  // namespace haptoflow::learning
