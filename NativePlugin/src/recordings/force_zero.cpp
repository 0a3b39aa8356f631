#include "recordings/force_zero.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numbers>

namespace haptoflow::recordings {
namespace {

/// Of the 95th percentile of the speed; a slower tip counts as resting.
constexpr double slidingShare = 0.2;
/// A sensor without load trembles around nothing by less than this, and by less than this share of the usual force.
constexpr double noiseNewtons = 0.02;
constexpr double noiseShare = 0.1;
constexpr double refusedShare = 0.05;
/// Above it, pressing itself is counted as negative; below, the zero is wrong.
constexpr double turnedShare = 0.9;

constexpr double frameSeconds = 0.02;
constexpr std::size_t minimumFrames = 25;
/// A tip that moves this much more quietly than it usually slides touches nothing.
constexpr double silentDb = -20.0;
constexpr double notedRestShare = 0.15;
constexpr double clearDrift = 0.7;
constexpr double driftShare = 0.6;
constexpr double steadyLevelDb = 1.0;
constexpr double fallingExponent = -0.2;
constexpr double clearFall = 0.25;

/// A frame of the recording in which the tip moves.
struct MovingFrame {
    double seconds = 0.0;
    double logSpeed = 0.0;
    double levelDb = 0.0;
    double newtons = 0.0;
};

struct Line {
    double slope = 0.0;
    double offset = 0.0;
    /// Share of the variance that it explains.
    double explained = 0.0;
};

template <typename X, typename Y>
Line lineOf(const std::vector<MovingFrame>& frames, const X& x, const Y& y) {
    const auto count = static_cast<double>(frames.size());
    std::array<double, 5> sums{};
    for (const MovingFrame& frame : frames) {
        sums[0] += x(frame) / count;
        sums[1] += y(frame) / count;
        sums[2] += x(frame) * x(frame) / count;
        sums[3] += y(frame) * y(frame) / count;
        sums[4] += x(frame) * y(frame) / count;
    }
    const double spread = sums[2] - sums[0] * sums[0];
    const double variance = sums[3] - sums[1] * sums[1];
    const double product = sums[4] - sums[0] * sums[1];
    const double slope = spread > 0.0 ? product / spread : 0.0;
    return {.slope = slope,
            .offset = sums[1] - slope * sums[0],
            .explained = variance > 0.0 ? slope * product / variance : 0.0};
}

/// Frames whose samples are all known.
std::vector<MovingFrame> movingFrames(const Recording& recording, double slowest) {
    const auto perFrame = static_cast<std::size_t>(frameSeconds * recording.rateHz);
    std::vector<MovingFrame> frames;
    for (std::size_t start = 1; start + perFrame <= recording.sampleCount(); start += perFrame) {
        const double squares = squaredSteps(recording, start, perFrame);
        double speed = 0.0;
        double newtons = 0.0;
        for (std::size_t i = start; i < start + perFrame; ++i) {
            speed += speedAt(recording, i) / static_cast<double>(perFrame);
            newtons += recording.forceNewtons[i] / static_cast<double>(perFrame);
        }
        if (speed > slowest && std::isfinite(squares) && std::isfinite(newtons)) {
            frames.push_back({.seconds = static_cast<double>(start) / recording.rateHz,
                              .logSpeed = std::log(speed),
                              .levelDb = 10.0 * std::log10(squares / static_cast<double>(perFrame) + 1e-12),
                              .newtons = newtons});
        }
    }
    return frames;
}

std::string newtons(double value) {
    return plainNumber(std::round(100.0 * value) / 100.0 + 0.0) + " N";
}

std::string remedyOf(const std::string& sidecar, bool isTurned) {
    const std::string sign =
        "where pressing counts as negative, give the key \"force_sign\": -1 in " + sidecar + " or --force-sign -1";
    const std::string rest =
        "where the sensor was not zeroed, subtract what it reads in the air, by the key \"force_rest_newtons\" or "
        "--force-rest-newtons";
    return isTurned ? sign + "; " + rest : rest + "; " + sign;
}

void noteRest(const std::string& place, const std::vector<MovingFrame>& frames, double usual,
              std::vector<std::string>& notes) {
    std::vector<double> levels;
    std::ranges::transform(frames, std::back_inserter(levels), &MovingFrame::levelDb);
    const double usualDb = quantile(levels, 0.75);
    std::vector<double> inAir;
    for (const MovingFrame& frame : frames) {
        if (frame.levelDb < usualDb + silentDb) {
            inAir.push_back(frame.newtons);
        }
    }
    if (inAir.size() < minimumFrames) {
        return;
    }
    const double rest = quantile(inAir, 0.5);
    if (std::abs(rest) > noiseNewtons + notedRestShare * usual) {
        notes.push_back(
            place + " is " + newtons(rest) +
            " where the tip moves without a sound, which is in the air; is the sensor zeroed? Subtract what "
            "it reads there, by the key \"force_rest_newtons\" or --force-rest-newtons");
    }
}

void noteDrift(const std::string& place, const std::vector<MovingFrame>& frames, double usual,
               std::vector<std::string>& notes) {
    const auto seconds = [](const MovingFrame& frame) { return frame.seconds; };
    const Line bySpeed = lineOf(
        frames, [](const MovingFrame& frame) { return frame.logSpeed; },
        [](const MovingFrame& frame) { return frame.levelDb; });
    const Line force = lineOf(frames, seconds, [](const MovingFrame& frame) { return frame.newtons; });
    const Line level = lineOf(frames, seconds,
                              [&](const MovingFrame& frame) { return frame.levelDb - bySpeed.slope * frame.logSpeed; });
    const double span = frames.back().seconds - frames.front().seconds;
    const double change = force.slope * span;
    const bool follows = std::copysign(1.0, change) * level.slope * span > steadyLevelDb;
    if (force.explained > clearDrift && std::abs(change) > driftShare * usual && !follows) {
        const auto at = [&](double time) { return newtons(force.offset + force.slope * time); };
        notes.push_back(place + " goes from " + at(frames.front().seconds) + " to " + at(frames.back().seconds) +
                        " over the recording, and the level does not follow; does the sensor drift? Compare what it "
                        "reads in the air before and after");
    }
}

/// Pressing makes every known surface stronger, or hardly matters.
void noteFall(const std::string& place, const std::vector<MovingFrame>& frames, std::vector<std::string>& notes) {
    std::vector<MovingFrame> pressed;
    std::copy_if(frames.begin(), frames.end(), std::back_inserter(pressed),
                 [](const MovingFrame& frame) { return frame.newtons > noiseNewtons; });
    if (pressed.size() < minimumFrames) {
        return;
    }
    const auto logSpeed = [](const MovingFrame& frame) { return frame.logSpeed; };
    const auto logForce = [](const MovingFrame& frame) { return std::log(frame.newtons); };
    const Line levelBySpeed = lineOf(pressed, logSpeed, [](const MovingFrame& frame) { return frame.levelDb; });
    const Line forceBySpeed = lineOf(pressed, logSpeed, logForce);
    const Line law = lineOf(
        pressed, [&](const MovingFrame& frame) { return logForce(frame) - forceBySpeed.slope * frame.logSpeed; },
        [&](const MovingFrame& frame) { return frame.levelDb - levelBySpeed.slope * frame.logSpeed; });
    const double exponent = law.slope * std::numbers::ln10 / 20.0;
    if (exponent < fallingExponent && law.explained > clearFall) {
        notes.push_back(place + ": the vibration grows weaker where it grows, as force^" +
                        plainNumber(std::round(100.0 * exponent) / 100.0) +
                        "; does the column count pressing as negative? Then give the key \"force_sign\": -1 or "
                        "--force-sign -1, and what the column reads in the air");
    }
}

}  // namespace

void checkForceZero(const std::string& path, const std::string& column, const std::string& sidecar,
                    const Recording& recording, std::vector<std::string>& notes) {
    const std::size_t count = recording.sampleCount();
    std::vector<double> speeds;
    std::vector<double> sizes;
    double lowest = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const double force = recording.forceNewtons[i];
        const double speed = speedAt(recording, i);
        if (std::isfinite(force) && std::isfinite(speed)) {
            speeds.push_back(speed);
            sizes.push_back(std::abs(force));
            lowest = std::min(lowest, force);
        }
    }
    if (sizes.empty()) {
        return;
    }
    const double slowest = slidingShare * quantile(speeds, 0.95);
    const double usual = quantile(sizes, 0.95);
    const double noise = std::max(noiseNewtons, noiseShare * usual);
    std::size_t sliding = 0;
    std::size_t negative = 0;
    std::size_t clamped = 0;
    double strongest = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
        const double force = recording.forceNewtons[i];
        if (!std::isfinite(force)) {
            continue;
        }
        clamped += force < -noiseNewtons ? 1U : 0U;
        if (speedAt(recording, i) > slowest) {
            ++sliding;
            negative += force < -noise ? 1U : 0U;
            strongest = std::max(strongest, force);
        }
    }
    const auto percent = [](std::size_t part, std::size_t whole) {
        return plainNumber(100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1)));
    };
    const double share = static_cast<double>(negative) / static_cast<double>(std::max<std::size_t>(sliding, 1));
    const std::string place = path + ": " + column;
    if (share > refusedShare) {
        throw RecordingUnusable(
            place + " is negative in " + percent(negative, sliding) + " % of the sliding, between " + newtons(lowest) +
            " and " + newtons(strongest) +
            "; expected a force that grows from 0 as the tip presses: " + remedyOf(sidecar, share > turnedShare));
    }
    if (clamped > 0) {
        notes.push_back(place + " is below 0 in " + percent(clamped, sizes.size()) + " % of its samples, down to " +
                        newtons(lowest) + ", and taken as 0 there; is the sensor zeroed?");
    }
    const std::vector<MovingFrame> frames = movingFrames(recording, slowest);
    if (frames.size() >= minimumFrames) {
        noteRest(place, frames, usual, notes);
        noteDrift(place, frames, usual, notes);
        noteFall(place, frames, notes);
    }
}

}  // namespace haptoflow::recordings
