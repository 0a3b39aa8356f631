#pragma once

#include "learning/learning_report.hpp"
#include "recordings/recording.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

namespace haptoflow::learning::testing {

/// A synthetic surface: noise through a resonance, with a level that is a power of speed and force, and optional ribs.
struct MadeSurface {
    double levelAtReference = 1.5;
    double speedExponent = 0.9;
    double forceExponent = 0.3;
    double resonanceHz = 180.0;
    /// Wave vector in cycles per millimetre; zero for none.
    std::array<double, 2> ribs{};
    std::array<double, 2> otherRibs{};
    /// Share of the level in each partial of the ribs.
    double ribShare = 0.9;
    /// Gain of the level above this speed.
    double stepMps = 0.0;
    double stepGain = 1.0;
};

struct MadeMotion {
    double seconds = 10.0;
    double minimumSpeedMps = 0.03;
    double maximumSpeedMps = 0.25;
    /// True if the direction rotates while the tip moves, false for motion along the first axis.
    bool cycles = true;
    /// Time for which speed and direction are constant; 0 for a motion that changes all the time.
    double strokeSeconds = 0.0;
};

/// A recording that owns the memory of its spans.
class MadeRecording {
public:
    MadeRecording(const MadeSurface& surface, const MadeMotion& motion, double rateHz = 4000.0, unsigned seed = 7)
        : rateHz_(rateHz) {
        const auto count = static_cast<std::size_t>(motion.seconds * rateHz);
        std::vector<float> noise(count);
        skeleton::fillStandardNormal({.seed = seed, .voice = 0, .segment = 0}, noise);
        const double turn = 2.0 * std::numbers::pi * surface.resonanceHz / rateHz;
        const double radius = std::exp(-0.5 * turn);
        const double first = 2.0 * radius * std::cos(turn);
        const double second = -radius * radius;
        // The resonance's gain for a wave with an RMS of 1.
        const double gain =
            std::sqrt((1.0 + second) * ((1.0 - second) * (1.0 - second) - first * first) / (1.0 - second));
        double one = 0.0;
        double two = 0.0;
        std::array<double, 2> way{};
        for (std::size_t i = 0; i < count; ++i) {
            const double time = static_cast<double>(i) / rateHz;
            const double moment =
                motion.strokeSeconds > 0.0 ? motion.strokeSeconds * std::floor(time / motion.strokeSeconds) : time;
            const double share = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * moment / 2.3);
            const double speed =
                motion.minimumSpeedMps * std::pow(motion.maximumSpeedMps / motion.minimumSpeedMps, share);
            const double direction = motion.cycles ? 0.9 * moment : 0.0;
            const double pressed = 0.8 + 0.4 * std::sin(2.0 * std::numbers::pi * time / 1.7);
            velocity.push_back(static_cast<float>(speed * std::cos(direction)));
            velocity.push_back(static_cast<float>(speed * std::sin(direction)));
            force.push_back(static_cast<float>(pressed));
            for (std::size_t axis = 0; axis < 2; ++axis) {
                way[axis] += 1000.0 / rateHz * velocity[2 * i + axis];
            }
            const double wave = gain * noise[i] + first * one + second * two;
            two = one;
            one = wave;
            double value = wave;
            for (const std::array<double, 2>& ribs : {surface.ribs, surface.otherRibs}) {
                if (ribs[0] != 0.0 || ribs[1] != 0.0) {
                    const double cycles = ribs[0] * way[0] + ribs[1] * way[1];
                    for (int partial = 1; partial <= 3; ++partial) {
                        value += surface.ribShare * std::numbers::sqrt2 / partial *
                                 std::cos(2.0 * std::numbers::pi * partial * cycles);
                    }
                }
            }
            const double level = surface.levelAtReference * std::pow(speed / 0.1, surface.speedExponent) *
                                 std::pow(pressed, surface.forceExponent) *
                                 (surface.stepMps > 0.0 && speed > surface.stepMps ? surface.stepGain : 1.0);
            acceleration.push_back(static_cast<float>(level * value));
        }
    }

    [[nodiscard]] recordings::Recording view() const {
        return {.rateHz = rateHz_,
                .axisCount = axisCount,
                .accelerationMps2 = acceleration,
                .velocityMps = velocity,
                .constantVelocityMps = constantVelocity,
                .forceNewtons = force,
                .constantForceNewtons = constantForce};
    }

    std::size_t axisCount = 1;
    std::vector<float> acceleration;
    std::vector<float> velocity;
    std::vector<float> force;
    std::array<double, 2> constantVelocity{};
    double constantForce = 0.0;

private:
    double rateHz_;
};

/// What a sensor with noise of 0.04 m/s^2 RMS on each axis measures at 4 kHz; the tip rests for the first second.
inline MadeRecording noisy(const MadeRecording& made, std::size_t axes = 1) {
    MadeRecording noisy = made;
    noisy.axisCount = axes;
    noisy.acceleration.resize(axes * made.acceleration.size());
    skeleton::fillStandardNormal({.seed = 12, .voice = 0, .segment = 0}, noisy.acceleration);
    for (std::size_t i = 0; i < made.acceleration.size(); ++i) {
        const bool rests = i < 4000;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            float& value = noisy.acceleration[i * axes + axis];
            value = 0.04F * value + (axis == 0 && !rests ? made.acceleration[i] : 0.0F);
        }
        noisy.velocity[2 * i] *= rests ? 0.0F : 1.0F;
        noisy.velocity[2 * i + 1] *= rests ? 0.0F : 1.0F;
    }
    return noisy;
}

/// A search that ends with its segments and not with its time.
inline LearningSettings briefSettings(std::uint64_t segmentBudget) {
    LearningSettings settings;
    settings.name = "made surface";
    settings.recordings = "made.csv";
    settings.secondsLimit = 600.0;
    settings.segmentBudget = segmentBudget;
    return settings;
}

}  // namespace haptoflow::learning::testing
