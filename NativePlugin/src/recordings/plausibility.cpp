#include "recordings/plausibility.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace haptoflow::recordings {
namespace {

// An accelerometer at rest measures gravity, unless its signal is high-passed.
constexpr std::array restInG{0.9, 1.1};
constexpr std::array restInMps2{6.0, 14.0};
constexpr std::array restInMilligravity{500.0, 2000.0};
// No stroke by hand makes a stylus vibrate more strongly.
constexpr double maximumRmsMps2 = 40.0 * gravityMps2;
constexpr double longestFrozenSeconds = 0.2;
constexpr double notedClippedShare = 0.001;

constexpr double minimumSpeedMps = 0.0005;
constexpr double maximumForceNewtons = 100.0;
constexpr double weakestNewtons = 0.002;
constexpr double spikeNewtons = 20.0;
constexpr double spikeRatio = 8.0;

bool isWithin(double value, const std::array<double, 2>& limits) {
    return value > limits[0] && value < limits[1];
}

std::string placeOf(const std::string& path, const Track& track, std::size_t index, const std::string& column) {
    std::string place = path;
    if (!track.lines.empty()) {
        place.append(":").append(std::to_string(track.lines[index]));
    }
    return place.append(": column ").append(column);
}

double share(std::size_t part, std::size_t whole) {
    return static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1));
}

double restOf(const Track& acceleration, std::span<double> means) {
    double squares = 0.0;
    for (std::size_t axis = 0; axis < acceleration.width; ++axis) {
        means[axis] = 0.0;
        for (std::size_t i = 0; i < acceleration.count(); ++i) {
            means[axis] += acceleration.at(i)[axis];
        }
        means[axis] /= static_cast<double>(acceleration.count());
        squares += means[axis] * means[axis];
    }
    return std::sqrt(squares);
}

void checkUnits(const std::string& path, const std::string& columns, const Track& acceleration) {
    std::array<double, 3> means{};
    const double restMps2 = restOf(acceleration, means);
    const bool isInG = columns.ends_with("_g");
    const double rest = isInG ? restMps2 / gravityMps2 : restMps2;
    const std::string first = columns.substr(0, columns.find(','));
    // The name up to its unit, such as "acceleration_x_"; empty for a channel of a WAV file, whose name has no unit.
    const std::string stem = first.substr(0, first.rfind('_') + 1);
    const std::string place = path + ": " + first + " rests at " + plainNumber(rest);
    // One axis may lie across gravity at any angle, so that 1 m/s^2 says nothing.
    if (!isInG && acceleration.width == 3 && !stem.empty() && isWithin(rest, restInG)) {
        throw RecordingUnusable(place + ", which looks like g; expected m/s^2 (9.8 at rest); name the columns " + stem +
                                "g and so on where they are in g");
    }
    if (isInG && isWithin(rest, restInMps2)) {
        throw RecordingUnusable(place + ", which looks like m/s^2; expected g (1 at rest); name the columns " + stem +
                                "mps2 and so on where they are in m/s^2");
    }
    if (isWithin(rest, restInMilligravity)) {
        throw RecordingUnusable(
            place + ", which looks like mg; expected " +
            std::string(isInG ? "g (1 at rest): divide by 1000" : "m/s^2 (9.8 at rest): divide by 102"));
    }
    double squares = 0.0;
    for (std::size_t i = 0; i < acceleration.values.size(); ++i) {
        const double deviation = acceleration.values[i] - means[i % acceleration.width];
        squares += deviation * deviation;
    }
    const double rms = std::sqrt(squares / static_cast<double>(acceleration.count()));
    if (!(rms > 0.0)) {
        fail(path, "the acceleration never changes", "a sensor that is connected");
    }
    if (rms > maximumRmsMps2) {
        fail(path, first + " has an RMS of " + plainNumber(rms) + " m/s^2", "at most " + plainNumber(maximumRmsMps2));
    }
}

void checkClipping(const std::string& path, const std::string& columns, const Track& acceleration,
                   std::vector<std::string>& notes) {
    double most = 0.0;
    std::vector<float> axis(acceleration.count());
    for (std::size_t each = 0; each < acceleration.width; ++each) {
        for (std::size_t i = 0; i < axis.size(); ++i) {
            axis[i] = static_cast<float>(acceleration.at(i)[each]);
        }
        most = std::max(most, clippedShare(axis, 1));
    }
    const std::string found = columns + " is clipped in " + plainNumber(100.0 * most) + " % of its samples";
    if (most > maximumClippedShare) {
        fail(path, found, "a sensor of a larger range: record again");
    }
    if (most > notedClippedShare) {
        notes.push_back(path + ": " + found + ", which are used as they are");
    }
}

/// Whether the sample belongs to a stretch in which no axis changes for longer than a sensor is ever still.
std::vector<std::uint8_t> frozenSamples(const Track& acceleration) {
    std::vector<std::uint8_t> frozen(acceleration.count());
    std::size_t first = 0;
    for (std::size_t i = 1; i <= acceleration.count(); ++i) {
        if (i < acceleration.count() && std::ranges::equal(acceleration.at(i), acceleration.at(first))) {
            continue;
        }
        if (acceleration.timeSeconds[i - 1] - acceleration.timeSeconds[first] > longestFrozenSeconds) {
            std::fill(frozen.begin() + static_cast<std::ptrdiff_t>(first),
                      frozen.begin() + static_cast<std::ptrdiff_t>(i), std::uint8_t{1});
        }
        first = i;
    }
    return frozen;
}

Track withoutFrozen(const std::string& path, Track acceleration, std::vector<std::string>& notes) {
    const std::vector<std::uint8_t> frozen = frozenSamples(acceleration);
    const auto left = static_cast<std::size_t>(std::ranges::count(frozen, std::uint8_t{0}));
    if (left == acceleration.count()) {
        return acceleration;
    }
    constexpr std::size_t minimumSamples = 4;
    if (left < minimumSamples) {
        fail(path, "the acceleration hardly ever changes", "a sensor that is connected");
    }
    const auto first = static_cast<std::size_t>(std::ranges::find(frozen, std::uint8_t{1}) - frozen.begin());
    notes.push_back(
        path + ": the acceleration stays the same in " +
        plainNumber(100.0 * share(acceleration.count() - left, acceleration.count())) + " % of its samples, from " +
        plainNumber(acceleration.timeSeconds[first] - acceleration.timeSeconds.front()) + " s on; these are left out");
    Track kept{.timeSeconds = {}, .values = {}, .width = acceleration.width, .lines = {}};
    for (std::size_t i = 0; i < acceleration.count(); ++i) {
        if (frozen[i] == 0) {
            const auto values = acceleration.at(i);
            kept.timeSeconds.push_back(acceleration.timeSeconds[i]);
            kept.values.insert(kept.values.end(), values.begin(), values.end());
        }
    }
    return kept;
}

std::string otherUnit(const std::string& columns) {
    if (columns == "speed_mps") {
        return "m/s; name the column speed_mmps where it is in mm/s";
    }
    if (columns == "speed_mmps") {
        return "mm/s; name the column speed_mps where it is in m/s";
    }
    if (columns.starts_with("position_x_mm")) {
        return "millimetres; name the columns position_x_m, position_y_m where they are in metres";
    }
    if (columns.starts_with("position_x_m")) {
        return "metres; name the columns position_x_mm, position_y_mm where they are in millimetres";
    }
    return "m/s (a thousandth of mm/s)";
}

double speedOf(const Track& velocity, std::size_t index) {
    const auto values = velocity.at(index);
    return std::hypot(values[0], values[1]);
}

void checkSpeeds(const std::string& path, const TableSeries& series, const Track& velocity) {
    std::vector<double> speeds(velocity.count());
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        speeds[i] = speedOf(velocity, i);
    }
    std::ranges::sort(speeds);
    const double fast = speeds[speeds.size() * 95 / 100];
    const auto moving = std::ranges::upper_bound(speeds, 0.2 * fast);
    if (moving == speeds.end()) {
        return;
    }
    const double median = *(moving + (speeds.end() - moving) / 2);
    if (!(median > minimumSpeedMps && median < maximumHandSpeedMps)) {
        fail(path, series.column() + " gives a speed of " + plainNumber(median) + " m/s", otherUnit(series.columns));
    }
}

void checkJumps(const std::string& path, const TableSeries& series, MotionForm form, const Track& velocity,
                const Track& motion) {
    const auto refuse = [&](const Track& track, std::size_t index, double speed) {
        if (speed > maximumHandSpeedMps) {
            fail(placeOf(path, track, index, series.column()), "jumps with " + plainNumber(speed) + " m/s",
                 "a tracker without jumps, at most 10 m/s: leave the cell empty");
        }
    };
    if (form != MotionForm::position) {
        for (std::size_t i = 0; i < velocity.count(); ++i) {
            refuse(velocity, i, speedOf(velocity, i));
        }
        return;
    }
    const Track read = readAnew(motion);
    for (std::size_t i = 1; i < read.count(); ++i) {
        const auto from = read.at(i - 1);
        const auto to = read.at(i);
        const double seconds = std::max(read.timeSeconds[i] - read.timeSeconds[i - 1], 1e-6);
        refuse(read, i, std::hypot(to[0] - from[0], to[1] - from[1]) / seconds);
    }
}

/// Logarithms of level and speed in frames; NaN where one of them is unknown.
struct Frames {
    std::vector<double> level;
    std::vector<double> speed;
};

constexpr double frameSeconds = 0.01;

Frames framesOf(const Recording& recording) {
    const auto perFrame = static_cast<std::size_t>(std::max(4.0, frameSeconds * recording.rateHz));
    Frames frames;
    for (std::size_t start = 1; start + perFrame <= recording.sampleCount(); start += perFrame) {
        const double squares = squaredSteps(recording, start, perFrame);
        double speed = 0.0;
        for (std::size_t i = start; i < start + perFrame; ++i) {
            speed += speedAt(recording, i);
        }
        frames.level.push_back(0.5 * std::log(squares / static_cast<double>(perFrame) + 1e-12));
        frames.speed.push_back(std::log(std::max(speed / static_cast<double>(perFrame), 0.002)));
    }
    return frames;
}

/// Correlation of the level with the speed `lag` frames later.
double correlation(const Frames& frames, std::ptrdiff_t lag) {
    std::array<double, 5> sums{};
    double count = 0.0;
    for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, -lag);
         i < std::ssize(frames.level) - std::max<std::ptrdiff_t>(0, lag); ++i) {
        const double level = frames.level[static_cast<std::size_t>(i)];
        const double speed = frames.speed[static_cast<std::size_t>(i + lag)];
        if (std::isfinite(level) && std::isfinite(speed)) {
            count += 1.0;
            sums[0] += level;
            sums[1] += speed;
            sums[2] += level * level;
            sums[3] += speed * speed;
            sums[4] += level * speed;
        }
    }
    const double spread = (count * sums[2] - sums[0] * sums[0]) * (count * sums[3] - sums[1] * sums[1]);
    return spread > 0.0 ? (count * sums[4] - sums[0] * sums[1]) / std::sqrt(spread) : 0.0;
}

}  // namespace

Track plausibleAcceleration(const std::string& path, const std::string& columns, Track acceleration,
                            std::vector<std::string>& notes) {
    checkUnits(path, columns, acceleration);
    checkClipping(path, columns, acceleration, notes);
    return withoutFrozen(path, std::move(acceleration), notes);
}

void checkMotion(const std::string& path, const TableSeries& series, MotionForm form, const Track& motion,
                 const Track& velocity) {
    checkSpeeds(path, series, velocity);
    checkJumps(path, series, form, velocity, motion);
}

void checkForce(const std::string& path, const TableSeries& series, const Track& force) {
    std::vector<double> sizes(force.count());
    std::ranges::transform(force.values, sizes.begin(), [](double value) { return std::abs(value); });
    const auto strongest = static_cast<std::size_t>(std::ranges::max_element(sizes) - sizes.begin());
    const double spike = sizes[strongest];
    const double median = quantile(sizes, 0.5);
    const double usual = quantile(sizes, 0.95);
    if (median > maximumForceNewtons) {
        fail(path, series.columns + " is " + plainNumber(median) + " N in the median",
             series.columns == "force_newtons" ? "newtons; name the column force_millinewtons where it is in mN"
                                               : "millinewtons");
    }
    if (usual < weakestNewtons) {
        fail(path, series.columns + " is " + plainNumber(usual) + " N at most",
             series.columns == "force_newtons" ? "newtons, and a tip that touches"
                                               : "millinewtons (name the column force_newtons where it is in N), and a "
                                                 "tip that touches");
    }
    if (spike > std::max(spikeNewtons, spikeRatio * usual)) {
        fail(placeOf(path, force, strongest, series.columns),
             "has a spike of " + plainNumber(spike) + " N where " + plainNumber(usual) + " N is usual",
             "no glitches: leave the cell empty");
    }
}

void noteLag(const std::string& path, const Recording& recording, std::vector<std::string>& notes) {
    constexpr std::ptrdiff_t searchedFrames = 50;
    constexpr std::ptrdiff_t notedFrames = 5;
    constexpr std::ptrdiff_t aroundFrames = 10;
    constexpr double clearCorrelation = 0.5;
    // By chance a shift explains a few per cent of the rest.
    constexpr double clearRatio = 1.15;
    constexpr double tie = 0.02;
    constexpr std::size_t minimumFrames = 300;
    if (recording.velocityMps.empty()) {
        return;
    }
    const Frames frames = framesOf(recording);
    std::size_t known = 0;
    for (std::size_t i = 0; i < frames.level.size(); ++i) {
        known += std::isfinite(frames.level[i]) && std::isfinite(frames.speed[i]) ? 1U : 0U;
    }
    if (known < minimumFrames) {
        return;
    }
    const double without = correlation(frames, 0);
    double best = without;
    for (std::ptrdiff_t lag = -searchedFrames; lag <= searchedFrames; ++lag) {
        best = std::max(best, correlation(frames, lag));
    }
    const auto unexplained = [](double correlated) { return 1.0 - std::max(correlated, 0.0) * correlated; };
    if (best < clearCorrelation || unexplained(without) < clearRatio * unexplained(best)) {
        return;
    }
    // Strokes that repeat explain the level at several lags; the shortest one is meant.
    std::ptrdiff_t nearest = 0;
    while (correlation(frames, nearest) < best - tie && correlation(frames, -nearest) < best - tie) {
        ++nearest;
    }
    const std::ptrdiff_t direction = correlation(frames, nearest) < correlation(frames, -nearest) ? -1 : 1;
    std::ptrdiff_t lag = direction * nearest;
    for (std::ptrdiff_t further = nearest; further <= nearest + aroundFrames; ++further) {
        lag = correlation(frames, direction * further) > correlation(frames, lag) ? direction * further : lag;
    }
    if (std::abs(lag) >= notedFrames) {
        const double milliseconds = 1000.0 * frameSeconds * static_cast<double>(std::abs(lag));
        notes.push_back(path + ": the motion seems to be " + plainNumber(milliseconds) + " ms " +
                        (lag > 0 ? "late" : "early") + ": shifted so, it explains the level better (correlation " +
                        plainNumber(best) + " instead of " + plainNumber(without) + "). Correct its time_s");
    }
}

}  // namespace haptoflow::recordings
