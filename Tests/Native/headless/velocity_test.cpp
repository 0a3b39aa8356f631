#include "headless/tip_path.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace haptoflow::headless {
namespace {

using testing::sampledPath;
using testing::surfaceOf;

const SceneSurface atRest = surfaceOf(Plane{});

/// The path of a tip over a surface, sample by sample.
class PathOn {
public:
    explicit PathOn(const SceneSurface& surface = atRest) : surface_(surface) {}

    TipStep add(double timeSeconds, const glm::dvec3& tip) {
        pose_ = surface_.poseAt(timeSeconds);
        return path_.add(timeSeconds, pose_.pointToLocal(tip), tip);
    }
    /// In the world's axes.
    [[nodiscard]] glm::dvec3 nowMps() const { return pose_.directionToWorld(relativeVelocity(path_).nowMps); }
    [[nodiscard]] glm::dvec3 approachMps() const { return pose_.directionToWorld(relativeVelocity(path_).approachMps); }
    [[nodiscard]] bool isSlow() const { return path_.isSlow(); }
    [[nodiscard]] double noiseMetres() const { return path_.noiseMetres(); }

private:
    SceneSurface surface_;
    Pose pose_;
    TipPath path_{VelocitySettings{}};
};

/// The speed after each sample.
std::vector<double> speedsOf(const std::vector<TipSample>& samples, const SceneSurface& surface = atRest) {
    PathOn history(surface);
    std::vector<double> speeds;
    for (const TipSample& sample : samples) {
        history.add(sample.timeSeconds, sample.positionMetres);
        speeds.push_back(glm::length(history.nowMps()));
    }
    return speeds;
}

glm::dvec3 alongX(double metres) {
    return {metres, 0.0, 0.0};
}

/// Normal noise on three axes, the same on every platform.
class Noise {
public:
    explicit Noise(double metres) : metres_(metres) {}
    glm::dvec3 next() { return glm::dvec3{one(), one(), one()}; }

private:
    double one() {
        double sum = -6.0;
        for (int part = 0; part < 12; ++part) {
            sum += static_cast<double>(random_()) / 4294967296.0;
        }
        return metres_ * sum;
    }

    double metres_;
    std::mt19937 random_{3};
};

TEST(VelocityTest, RepeatedPositionsChangeTheVelocityByLessThanFivePercent) {
    std::mt19937 random(4);
    for (const double rate : {72.0, 90.0, 108.0, 120.0}) {
        // A third of the samples, at random; and as of a real tracker, whose positions are as old as its measurements.
        auto atRandom = sampledPath(4.0, rate, [](double time) { return alongX(0.3 * time); });
        int run = 0;
        for (std::size_t frame = 1; frame < atRandom.size(); ++frame) {
            run = random() % 3 == 0 && run < 2 ? run + 1 : 0;
            if (run > 0) {
                atRandom[frame].positionMetres = atRandom[frame - 1].positionMetres;
            }
        }
        const double tick = 1.5 / rate;
        const auto ofTracker = sampledPath(
            4.0, rate, [&](double time) { return alongX(0.3 * tick * std::floor((time + 0.2 * tick) / tick)); });
        for (const auto& samples : {atRandom, ofTracker}) {
            const auto speeds = speedsOf(samples);
            for (std::size_t frame = 6; frame < speeds.size(); ++frame) {
                EXPECT_NEAR(speeds[frame], 0.3, 0.015) << rate << " Hz, frame " << frame;
            }
        }
    }
}

TEST(VelocityTest, AnAcceleratedTipHasTheVelocityOfNow) {
    const double acceleration = 2.0;
    for (const double rate : {72.0, 90.0, 120.0, 1000.0}) {
        const auto samples =
            sampledPath(0.5, rate, [&](double time) { return alongX(0.5 * acceleration * time * time); });
        const double lagSeconds = samples.back().timeSeconds - speedsOf(samples).back() / acceleration;
        EXPECT_NEAR(lagSeconds, 0.0, 0.001) << rate;
    }
}

TEST(VelocityTest, AScribbleWithNoiseIsFollowedWithinThreeDecibels) {
    for (const double rate : {72.0, 90.0, 120.0}) {
        for (const auto& [hertz, metres] : {std::pair(2.0, 0.020), {3.0, 0.010}}) {
            Noise noise(1e-4);
            const double turn = 2.0 * std::numbers::pi * hertz;
            const auto samples = sampledPath(
                8.0, rate, [&](double time) { return alongX(metres * std::sin(turn * time)) + noise.next(); });
            const auto speeds = speedsOf(samples);
            double squares = 0.0;
            int count = 0;
            for (std::size_t frame = samples.size() / 8; frame < samples.size(); ++frame) {
                const double wanted = std::abs(metres * turn * std::cos(turn * samples[frame].timeSeconds));
                if (wanted > 0.03) {
                    squares += std::pow(20.0 * std::log10(std::max(speeds[frame], 1e-3) / wanted), 2.0);
                    ++count;
                }
            }
            EXPECT_LT(std::sqrt(squares / count), 3.0) << rate << " Hz, " << hertz << " Hz";
        }
    }
}

TEST(VelocityTest, ATrackersNoiseOfATenthOfAMillimetreAtRestIsBelowEightMillimetresASecond) {
    for (const double rate : {72.0, 90.0, 120.0, 500.0, 1000.0}) {
        Noise noise(1e-4);
        const auto speeds = speedsOf(sampledPath(10.0, rate, [&](double) { return noise.next(); }));
        double squares = 0.0;
        for (std::size_t frame = speeds.size() / 10; frame < speeds.size(); ++frame) {
            squares += speeds[frame] * speeds[frame];
        }
        EXPECT_LT(std::sqrt(squares / (0.9 * static_cast<double>(speeds.size()))), 0.008) << rate << " Hz";
    }
}

TEST(VelocityTest, AStartAndAStopAreHalfFollowedWithinOneAndAHalfIntervals) {
    for (const double rate : {72.0, 90.0, 120.0}) {
        for (const double noiseMetres : {0.0, 2e-5}) {
            double intervals = 0.0;
            int steps = 0;
            for (const double phase : {0.1, 0.3, 0.5, 0.7, 0.9}) {
                Noise noise(noiseMetres);
                // Moving from 1 s and from 3 s on, at rest from 2 s on.
                const double start = 1.0 + phase / rate;
                const auto samples = sampledPath(3.5, rate, [&](double time) {
                    const double since = time - start;
                    return alongX(0.15 * (std::clamp(since, 0.0, 1.0) + std::max(0.0, since - 2.0)) +
                                  0.05 * std::min(time, 0.7)) +
                           noise.next();
                });
                const auto speeds = speedsOf(samples);
                for (const double step : {start, start + 1.0, start + 2.0}) {
                    std::size_t frame = 0;
                    while (samples[frame].timeSeconds < step ||
                           (step == start + 1.0 ? speeds[frame] > 0.075 : speeds[frame] < 0.075)) {
                        ++frame;
                    }
                    intervals += (samples[frame].timeSeconds - step) * rate;
                    ++steps;
                }
            }
            EXPECT_LT(intervals / steps, 1.5) << rate << " Hz, noise " << noiseMetres;
        }
    }
}

TEST(VelocityTest, ATrackerThatNeverRepeatsItselfHasStoppedAfterTwoFrames) {
    for (const double rate : {72.0, 120.0, 1000.0}) {
        const auto samples = sampledPath(1.0, rate, [](double time) { return alongX(0.5 * std::min(time, 0.7)); });
        const auto speeds = speedsOf(samples);
        for (std::size_t frame = 0; frame < samples.size(); ++frame) {
            if (samples[frame].timeSeconds > 0.7 + 2.5 / rate) {
                EXPECT_EQ(speeds[frame], 0.0) << rate << " Hz at " << samples[frame].timeSeconds;
            }
        }
    }
}

TEST(VelocityTest, ATrackerThatBecomesSlowIsNoticedAndOneThatBecomesFastIsTrustedAgain) {
    // Every third frame from 1 s on; every frame again from 3 s on.
    const double rate = 90.0;
    PathOn history;
    for (const TipSample& sample : sampledPath(4.0, rate, [&](double time) {
             const double tick = time < 1.0 || time > 3.0 ? 1.0 / rate : 3.0 / rate;
             return alongX(0.2 * tick * std::floor(time / tick + 1e-6));
         })) {
        history.add(sample.timeSeconds, sample.positionMetres);
        const double time = sample.timeSeconds;
        if (time < 1.0 || time > 3.5) {
            EXPECT_FALSE(history.isSlow()) << time;
        } else if (time > 1.1 && time < 3.0) {
            EXPECT_TRUE(history.isSlow()) << time;
            EXPECT_NEAR(history.nowMps().x, 0.2, 0.01) << time;
        }
    }
}

TEST(VelocityTest, TheNoiseOfATrackerIsFoundFromRestAndFromScribbles) {
    for (const double rate : {72.0, 120.0, 500.0}) {
        for (const double metres : {2e-5, 1e-4, 3e-4}) {
            for (const double amplitude : {0.0, 0.010}) {
                Noise noise(metres);
                PathOn history;
                for (const TipSample& sample : sampledPath(4.0, rate, [&](double time) {
                         return alongX(amplitude * std::sin(6.0 * std::numbers::pi * time)) + noise.next();
                     })) {
                    history.add(sample.timeSeconds, sample.positionMetres);
                }
                EXPECT_GT(history.noiseMetres(), 0.5 * metres) << rate << " Hz, amplitude " << amplitude;
                EXPECT_LT(history.noiseMetres(), 2.0 * metres) << rate << " Hz, amplitude " << amplitude;
            }
        }
    }
}

TEST(VelocityTest, ATrackersNoiseIsBoundedWhateverItSays) {
    Noise wild(0.02);
    PathOn history;
    for (int frame = 0; frame < 2000; ++frame) {
        history.add(frame / 90.0, wild.next());
    }
    EXPECT_LE(history.noiseMetres(), 5e-4);
    for (int frame = 2000; frame < 4000; ++frame) {
        history.add(frame / 90.0, alongX(0.1 * frame / 90.0));
    }
    EXPECT_GE(history.noiseMetres(), 5e-6);
}

TEST(VelocityTest, AlmostEqualTimesAndHitchesKeepTheVelocityNearTheTrueOne) {
    // Pairs of frames half a millisecond apart, and now and then a frame that takes 80 ms.
    std::mt19937 random(5);
    Noise noise(2e-5);
    PathOn history;
    double time = 0.0;
    double squares = 0.0;
    for (int frame = 0; frame < 5000; ++frame) {
        time += frame % 2 == 0 ? 0.00051 : random() % 20 == 0 ? 0.080 : 0.0215;
        history.add(time, alongX(0.2 * time) + noise.next());
        const double error = history.nowMps().x - 0.2;
        squares += frame < 100 ? 0.0 : error * error;
    }
    EXPECT_LT(std::sqrt(squares / 4900.0), 0.02);
}

TEST(VelocityTest, WhateverTheTrackerSaysTheVelocityIsFiniteAndNoFasterThanTheLimit) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    for (int round = 0; round < 200; ++round) {
        PathOn history;
        double time = 1000.0 * uniform(random);
        glm::dvec3 place(0.0);
        for (int frame = 0; frame < 300; ++frame) {
            time += std::pow(10.0, -4.0 + 3.0 * std::abs(uniform(random)));
            const double metres = std::pow(10.0, -9.0 + 8.0 * std::abs(uniform(random)));
            if (random() % 3 != 0) {
                place += metres * glm::dvec3(uniform(random), uniform(random), uniform(random));
            }
            history.add(time, place);
            const RelativeVelocity velocity{history.nowMps(), history.approachMps()};
            ASSERT_LE(glm::length(velocity.nowMps), 20.0 * (1.0 + 1e-12));
            ASSERT_LE(glm::length(velocity.approachMps), 20.0 * (1.0 + 1e-12));
        }
    }
}

TEST(VelocityTest, AStopFadesMonotonically) {
    // Of a tracker that has not yet shown that it never repeats itself.
    const auto samples = sampledPath(0.5, 1000.0, [](double time) { return alongX(0.5 * std::min(time, 0.025)); });
    const auto speeds = speedsOf(samples);
    for (std::size_t frame = 27; frame < speeds.size(); ++frame) {
        EXPECT_LE(speeds[frame], speeds[frame - 1] + 1e-9);
        EXPECT_GT(speeds[frame], speeds[frame - 1] - 0.05);
    }
}

TEST(VelocityTest, ASurfaceThatJumpsBackAtTheEndOfItsLoopIsNotAStroke) {
    SceneSurface plate = surfaceOf(Plane{});
    plate.motion.emplace(std::vector<Keyframe>{{0.0, {}}, {1.0, {{0.5, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}}, true);
    PathOn history(plate);
    for (int frame = 0; frame <= 270; ++frame) {
        history.add(frame / 90.0, alongX(0.0));
        EXPECT_LT(glm::length(history.nowMps()), 0.51) << frame;
    }
}

}  // namespace
}  // namespace haptoflow::headless
