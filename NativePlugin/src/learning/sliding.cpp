#include "learning/sliding.hpp"

#include "inference/segment_generator.hpp"
#include "learning/numerics.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>
#include <utility>

namespace haptoflow::learning {
namespace {

constexpr double sampleSeconds = 1.0 / inference::waveformRateHz;
constexpr double lightestTouchNewtons = 0.02;
/// A larger speed is more probably a column in millimetres per second than a hand.
constexpr double maximumHandMps = 5.0;
constexpr double maximumHandNewtons = 50.0;

std::array<double, 3> percentiles(const std::vector<double>& values) {
    return {recordings::quantile(values, 0.02), recordings::quantile(values, 0.5), recordings::quantile(values, 0.98)};
}

void checkUnits(double medianSpeed, double medianForce, const model::ModelHeader& model) {
    if (medianSpeed > maximumHandMps) {
        throw recordings::RecordingUnusable("the speed is " + recordings::plainNumber(medianSpeed) +
                                            " m/s in the median, which no hand reaches; is it in mm/s?");
    }
    if (medianSpeed > model.speedMps.maximum) {
        throw recordings::RecordingUnusable("the speed is " + recordings::plainNumber(medianSpeed) +
                                            " m/s in the median; the model was trained up to " +
                                            recordings::plainNumber(model.speedMps.maximum) + " m/s");
    }
    if (medianForce > maximumHandNewtons) {
        throw recordings::RecordingUnusable("the force is " + recordings::plainNumber(medianForce) +
                                            " N in the median, which no hand presses; is it in millinewtons?");
    }
}

}  // namespace

bool Sliding::holds(std::size_t first, std::size_t count) const {
    return first + count < before.size() && before[first + count] - before[first] == count;
}

Sliding findSliding(const recordings::PreparedRecording& recording, const model::ModelHeader& model) {
    constexpr double beyondRange = 1.05;
    std::vector<double> speeds;
    std::vector<double> forces;
    std::size_t usable = 0;
    const std::size_t count = recording.wave.size();
    for (std::size_t i = 0; i < count; ++i) {
        usable += recording.isUsable[i];
        if (recording.isUsable[i] != 0 && recording.speedMps(i) >= minimumSlidingMps) {
            speeds.push_back(recording.speedMps(i));
            forces.push_back(recording.motion[i][2]);
        }
    }
    const auto seconds = [](std::size_t samples) {
        return recordings::plainNumber(static_cast<double>(samples) * sampleSeconds);
    };
    if (speeds.empty()) {
        throw recordings::RecordingUnusable("the tip never moves: the speed stays below " +
                                            recordings::plainNumber(1000.0 * minimumSlidingMps) +
                                            " mm/s; give the speed, or record sliding strokes");
    }
    const double medianForce = percentiles(forces)[1];
    checkUnits(percentiles(speeds)[1], medianForce, model);
    if (medianForce < lightestTouchNewtons) {
        throw recordings::RecordingUnusable("the force is " + recordings::plainNumber(medianForce) +
                                            " N in the median while the tip moves; give the force in newtons");
    }

    Sliding sliding;
    sliding.isSliding.resize(count);
    sliding.before.resize(count + 1);
    std::vector<double> keptSpeeds;
    std::vector<double> keptForces;
    for (std::size_t i = 0; i < count; ++i) {
        const double speed = recording.speedMps(i);
        const double force = recording.motion[i][2];
        const bool slides = recording.isUsable[i] != 0 && speed >= minimumSlidingMps && force >= lightestTouchNewtons &&
                            speed <= beyondRange * model.speedMps.maximum;
        sliding.isSliding[i] = slides ? 1 : 0;
        sliding.before[i + 1] = sliding.before[i] + (slides ? 1U : 0U);
        if (slides) {
            keptSpeeds.push_back(speed);
            keptForces.push_back(force);
        }
    }
    sliding.seconds = static_cast<double>(keptSpeeds.size()) * sampleSeconds;
    if (sliding.seconds < recordings::minimumSlidingSeconds) {
        throw recordings::RecordingUnusable(
            "the tip slides for " + seconds(keptSpeeds.size()) + " s of " + seconds(count) + " s (" +
            seconds(count - usable) +
            " s were left out around missing or frozen samples); record 10 s or more of "
            "sliding");
    }
    sliding.speedMps = percentiles(keptSpeeds);
    sliding.forceNewtons = percentiles(keptForces);
    return sliding;
}

namespace {

constexpr double millimetresPerMetre = 1000.0;
/// A path of this length contains many ribs, and the tracker's error over it is less than one rib.
constexpr double targetPathMm = 35.0;
constexpr std::size_t minimumSamples = 160;
constexpr std::size_t maximumSamples = 1000;
/// Windows with a more curved or a shorter path do not determine a direction.
constexpr double minimumStraightness = 0.96;
constexpr double minimumPathMm = 4.0;
constexpr std::size_t predictorOrder = 10;
constexpr std::size_t levelReachSamples = 100;
constexpr std::size_t maximumWindows = 200;

/// One usable stretch of the recording.
struct Part {
    std::size_t first = 0;
    std::vector<double> wave;
};

/// Each sample divided by the RMS of the tenth of a second around it.
std::vector<double> evened(std::span<const float> wave) {
    std::vector<double> sums(wave.size() + 1);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        sums[i + 1] = sums[i] + static_cast<double>(wave[i]) * wave[i];
    }
    std::vector<double> result(wave.size());
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const std::size_t first = i - std::min(i, levelReachSamples);
        const std::size_t last = std::min(i + levelReachSamples, wave.size());
        const double square = (sums[last] - sums[first]) / static_cast<double>(last - first);
        result[i] = wave[i] / (std::sqrt(square) + 1e-6);
    }
    return result;
}

std::vector<Part> usableParts(const recordings::PreparedRecording& recording) {
    std::vector<Part> parts;
    const std::size_t count = recording.wave.size();
    for (std::size_t first = 0; first < count;) {
        std::size_t last = first;
        while (last < count && recording.isUsable[last] != 0) {
            ++last;
        }
        if (last - first > minimumSamples) {
            parts.push_back({first, evened(std::span(recording.wave).subspan(first, last - first))});
        }
        first = last + 1;
    }
    return parts;
}

/// The coefficients of one linear predictor for all parts.
std::vector<double> predictorTaps(const std::vector<Part>& parts, const Sliding& sliding) {
    std::vector<double> correlation(predictorOrder + 1);
    for (const Part& part : parts) {
        for (std::size_t i = predictorOrder; i < part.wave.size(); ++i) {
            if (sliding.isSliding[part.first + i] != 0) {
                for (std::size_t lag = 0; lag <= predictorOrder; ++lag) {
                    correlation[lag] += part.wave[i] * part.wave[i - lag];
                }
            }
        }
    }
    SymmetricMatrix matrix(predictorOrder);
    for (std::size_t i = 0; i < predictorOrder; ++i) {
        for (std::size_t j = 0; j < predictorOrder; ++j) {
            matrix.at(i, j) = correlation[i > j ? i - j : j - i];
        }
        matrix.at(i, i) += 1e-3 * correlation[0] + 1e-12;
    }
    return solvePositive(std::move(matrix), {correlation.begin() + 1, correlation.end()});
}

/// The prediction error, without the spectral envelope of surface and tool; lines remain.
std::vector<double> whitened(std::span<const double> wave, std::span<const double> taps) {
    std::vector<double> result(wave.size());
    for (std::size_t i = predictorOrder; i < wave.size(); ++i) {
        double error = wave[i];
        for (std::size_t lag = 1; lag <= predictorOrder; ++lag) {
            error -= taps[lag - 1] * wave[i - lag];
        }
        result[i] = error;
    }
    return result;
}

std::optional<PathWindow> windowAt(const recordings::PreparedRecording& recording, std::span<const double> white,
                                   std::size_t first) {
    const std::size_t count = white.size();
    PathWindow window;
    double x = 0.0;
    double y = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto& motion = recording.motion[first + i];
        window.xMm.push_back(x);
        window.yMm.push_back(y);
        x += millimetresPerMetre / inference::waveformRateHz * motion[0];
        y += millimetresPerMetre / inference::waveformRateHz * motion[1];
        window.pathMm += millimetresPerMetre / inference::waveformRateHz * recording.speedMps(first + i);
        squares += white[i] * white[i];
    }
    const double straight = std::hypot(x, y);
    if (straight < minimumStraightness * window.pathMm || window.pathMm < minimumPathMm || !(squares > 0.0)) {
        return std::nullopt;
    }
    window.directionX = x / straight;
    window.directionY = y / straight;
    window.speedMmps = window.pathMm * inference::waveformRateHz / static_cast<double>(count);
    const double rms = std::sqrt(squares / static_cast<double>(count));
    const double middleX = window.xMm[count / 2];
    const double middleY = window.yMm[count / 2];
    for (std::size_t i = 0; i < count; ++i) {
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(i + 1) / static_cast<double>(count + 1);
        window.hann.push_back(0.5 - 0.5 * std::cos(turn));
        window.hannSum += window.hann[i];
        window.wave.push_back(window.hann[i] * white[i] / rms);
        window.xMm[i] -= middleX;
        window.yMm[i] -= middleY;
    }
    return window;
}

std::size_t windowLength(double speedMps) {
    const double samples =
        targetPathMm * inference::waveformRateHz / (millimetresPerMetre * std::max(speedMps, minimumSlidingMps));
    return static_cast<std::size_t>(
        std::clamp(samples, static_cast<double>(minimumSamples), static_cast<double>(maximumSamples)));
}

}  // namespace

std::vector<PathWindow> pathWindows(const recordings::PreparedRecording& recording, const Sliding& sliding) {
    const std::vector<Part> parts = usableParts(recording);
    const std::vector<double> taps = predictorTaps(parts, sliding);
    std::vector<PathWindow> windows;
    for (const Part& part : parts) {
        const std::vector<double> white = whitened(part.wave, taps);
        for (std::size_t start = predictorOrder; start + minimumSamples <= white.size();) {
            const std::size_t first = part.first + start;
            const std::size_t count = windowLength(recording.speedMps(first));
            if (start + count > white.size() || !sliding.holds(first, count)) {
                start += minimumSamples / 2;
                continue;
            }
            if (std::optional<PathWindow> window = windowAt(recording, std::span(white).subspan(start, count), first)) {
                windows.push_back(std::move(*window));
            }
            start += count / 2;
        }
    }
    if (windows.size() <= maximumWindows) {
        return windows;
    }
    std::vector<PathWindow> kept;
    for (std::size_t i = 0; i < maximumWindows; ++i) {
        kept.push_back(std::move(windows[i * windows.size() / maximumWindows]));
    }
    return kept;
}

}  // namespace haptoflow::learning
