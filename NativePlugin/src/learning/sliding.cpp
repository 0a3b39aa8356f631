#include "learning/sliding.hpp"

#include "inference/segment_generator.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace haptoflow::learning {
namespace {

constexpr double sampleSeconds = 1.0 / inference::waveformRateHz;
constexpr double lightestTouchNewtons = 0.02;
/// A larger speed is more probably a column in millimetres per second than a hand.
constexpr double maximumHandMps = 5.0;
constexpr double maximumHandNewtons = 50.0;

std::array<double, 3> percentiles(std::vector<double> values) {
    if (values.empty()) {
        return {};
    }
    std::ranges::sort(values);
    const auto at = [&](double share) {
        return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    return {at(0.02), at(0.5), at(0.98)};
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
    sliding.speedMps = percentiles(std::move(keptSpeeds));
    sliding.forceNewtons = percentiles(std::move(keptForces));
    return sliding;
}

}  // namespace haptoflow::learning
