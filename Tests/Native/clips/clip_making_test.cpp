#include "clips/clip_making.hpp"
#include "clips/clip_signals.hpp"
#include "effects/device_loudness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace haptoflow::clips {
namespace {

using haptoflow::testing::rms;

double shareOf(double amplitudeMps2) {
    return static_cast<double>(
        effects::deviceShare(effects::DeviceKind::parametric, static_cast<float>(amplitudeMps2)));
}

TEST(ClipMakingTest, ASineBecomesItsShareOfTheDeviceAndItsFrequency) {
    const HapticClip clip = clipOf(sine(150.0, 4.0, 1.0));
    EXPECT_DOUBLE_EQ(clip.durationSeconds, 1.0);
    for (const double seconds : {0.3, 0.5, 0.9}) {
        EXPECT_NEAR(valueAt(clip.amplitude, seconds, 0.0), shareOf(4.0), 0.02 * shareOf(4.0)) << seconds;
        EXPECT_NEAR(valueAt(clip.frequencyHz, seconds, 0.0), 150.0, 3.0) << seconds;
    }
}

TEST(ClipMakingTest, CurvesReachFromTheBeginningToTheEnd) {
    const HapticClip clip = clipOf(noise(2.0, 0.777));
    for (const std::vector<ClipPoint>* points : {&clip.amplitude, &clip.frequencyHz}) {
        EXPECT_EQ(points->front().seconds, 0.0);
        EXPECT_EQ(points->back().seconds, clip.durationSeconds);
        EXPECT_TRUE(std::ranges::is_sorted(*points, {}, &ClipPoint::seconds));
    }
}

TEST(ClipMakingTest, ATapIsATransientAtItsTimeAndLeavesTheAmplitude) {
    std::vector<float> wave = sine(120.0, 0.3, 1.0);
    addTap(wave, 0.5, 20.0);
    const HapticClip clip = clipOf(wave);
    // The wave's own beginning is the first.
    ASSERT_EQ(clip.transients.size(), 2U);
    EXPECT_NEAR(clip.transients[1].seconds, 0.5, 0.002);
    EXPECT_GT(clip.transients[1].amplitude, 3.0 * shareOf(0.3));
    EXPECT_NEAR(clip.transients[1].frequencyHz, 200.0, 60.0);
    // The tap's energy would be eight times the texture's here.
    for (const double seconds : {0.502, 0.506, 0.510, 0.516}) {
        EXPECT_LT(valueAt(clip.amplitude, seconds, 0.0), 2.0 * shareOf(0.3)) << seconds;
    }
    EXPECT_NEAR(valueAt(clip.amplitude, 0.4, 0.0), shareOf(0.3), 0.1 * shareOf(0.3));
}

TEST(ClipMakingTest, WhatAClipPlaysIsAsStrongAsTheWave) {
    // By a device with the whole range, after the loudness law is undone.
    std::vector<float> wave = sine(90.0, 1.5, 2.0);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] *= static_cast<float>(1.0 + 0.5 * std::sin(0.01 * static_cast<double>(i)));
    }
    const std::vector<float> played = waveOf(clipOf(wave), testRateHz);
    ASSERT_EQ(played.size(), wave.size());
    const auto half = std::span(wave).subspan(400, 3000);
    EXPECT_NEAR(20.0 * std::log10(rms(std::span(played).subspan(400, 3000)) / rms(half)), 0.0, 0.5);
}

TEST(ClipMakingTest, ALoopedWaveGivesAClipThatGoesOnAtItsBeginning) {
    const std::vector<float> loop = loopOf(noise(3.0, 5.0), 7000, 8000, 200);
    const HapticClip clip = clipOf(loop, {.isLoop = true});
    for (const std::vector<ClipPoint>* points : {&clip.amplitude, &clip.frequencyHz}) {
        EXPECT_EQ(points->front().seconds, 0.0);
        EXPECT_EQ(points->back().seconds, clip.durationSeconds);
        EXPECT_EQ(points->front().value, points->back().value);
    }
    // It begins within the texture, not in silence, as the clip of the same wave that is no loop does.
    EXPECT_GT(clip.amplitude.front().value, 0.5 * valueAt(clip.amplitude, 1.0, 0.0));
}

TEST(ClipMakingTest, SamplesThatAreNotFiniteCountAsSilence) {
    std::vector<float> wave = sine(150.0, 4.0, 0.5);
    wave[300] = std::numeric_limits<float>::quiet_NaN();
    wave[301] = std::numeric_limits<float>::infinity();
    for (const ClipPoint& point : clipOf(wave).amplitude) {
        EXPECT_TRUE(std::isfinite(point.value) && point.value >= 0.0 && point.value <= 1.0);
    }
}

TEST(ClipMakingTest, AnEmptyAndAnEndlessWaveAreRefused) {
    EXPECT_THROW((void)clipOf({}), ClipError);
    EXPECT_THROW((void)clipOf(std::vector<float>(1'200'001)), ClipError);
}

TEST(LoopTest, NoClickAndNoDipWhereItCloses) {
    double seam = 0.0;
    double elsewhere = 0.0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        // Red noise: a jump is far larger than its steps.
        std::vector<float> wave = noise(1.0, 3.0, seed);
        for (std::size_t i = 1; i < wave.size(); ++i) {
            wave[i] += 0.9F * wave[i - 1];
        }
        const std::vector<float> loop = loopOf(wave, 4000, 4400, 200);
        seam += std::pow(loop.front() - loop.back(), 2.0);
        elsewhere += std::pow(loop[2001] - loop[2000], 2.0);
    }
    EXPECT_LT(seam, 1.5 * elsewhere);
}

TEST(LoopTest, TheCrossfadeKeepsTheLevelWhateverTheCorrelation) {
    const auto levelOfCrossfade = [](const auto& make) {
        double crossfade = 0.0;
        double rest = 0.0;
        for (unsigned seed = 1; seed <= 200; ++seed) {
            const std::vector<float> loop = loopOf(make(seed), 4000, 4400, 200);
            crossfade += std::pow(rms(std::span(loop).first(200)), 2.0);
            rest += std::pow(rms(std::span(loop).subspan(1000, 2000)), 2.0);
        }
        return 10.0 * std::log10(crossfade / rest);
    };
    EXPECT_NEAR(levelOfCrossfade([](unsigned seed) { return noise(1.0, 3.0, seed); }), 0.0, 0.5);
    EXPECT_NEAR(levelOfCrossfade([](unsigned seed) { return sine(40.0 + seed, 1.0, 3.0); }), 0.0, 0.5);
}

TEST(LoopTest, APeriodicWaveClosesInPhase) {
    const std::vector<float> loop = loopOf(sine(97.3, 1.0, 3.0), 4000, 4400, 100);
    double cycles = 97.3 * static_cast<double>(loop.size()) / testRateHz;
    cycles -= std::round(cycles);
    EXPECT_NEAR(cycles, 0.0, 0.03);
}

TEST(LoopTest, TooShortAWaveIsRefused) {
    EXPECT_THROW((void)loopOf(noise(1.0, 1.0), 1000, 1950, 100), std::invalid_argument);
    EXPECT_THROW((void)loopOf(noise(1.0, 1.0), 50, 900, 100), std::invalid_argument);
}

std::vector<ClipPoint> randomWalk(unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    std::vector<ClipPoint> points;
    double logarithm = -1.5;
    for (int i = 0; i < 2000; ++i) {
        logarithm = std::clamp(logarithm + 0.15 * normal(engine), -8.0, 0.0);
        points.push_back({0.004 * i, std::exp(logarithm)});
    }
    return points;
}

TEST(ThinTest, EveryPointThatIsLeftOutLiesWithinTheTolerance) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const std::vector<ClipPoint> points = randomWalk(seed);
        const Thinned thinned = thin(points, 0.5, 0.02, points.size());
        EXPECT_LT(thinned.points.size(), points.size());
        EXPECT_LE(thinned.errorDb, 0.55);
        for (const ClipPoint& point : points) {
            const double played = valueAt(thinned.points, point.seconds, 0.0);
            const double room = std::max(point.value, 0.02) * (std::pow(10.0, 0.5 / 20.0) - 1.0);
            EXPECT_NEAR(played, point.value, 1.0001 * room) << point.seconds;
        }
    }
}

TEST(ThinTest, TheNumberOfPointsIsAHardLimitAndTheErrorIsSaid) {
    const std::vector<ClipPoint> points = randomWalk(3);
    const Thinned fine = thin(points, 0.5, 0.02, points.size());
    const Thinned coarse = thin(points, 0.5, 0.02, 60);
    EXPECT_GT(fine.points.size(), 60U);
    EXPECT_LE(coarse.points.size(), 60U);
    EXPECT_GT(coarse.errorDb, fine.errorDb);
}

TEST(ThinTest, AJumpStaysAJump) {
    const std::vector<ClipPoint> points{{0.0, 0.2}, {0.1, 0.2}, {0.2, 0.2}, {0.2, 0.8}, {0.3, 0.8}, {0.4, 0.8}};
    const Thinned thinned = thin(points, 0.5, 0.02, 100);
    ASSERT_EQ(thinned.points.size(), 4U);
    EXPECT_EQ(thinned.points[1].value, 0.2);
    EXPECT_EQ(thinned.points[2].value, 0.8);
    EXPECT_EQ(thinned.points[1].seconds, thinned.points[2].seconds);
}

TEST(ThinTest, AStraightLineNeedsItsEndsAlone) {
    std::vector<ClipPoint> points;
    for (int i = 0; i <= 100; ++i) {
        points.push_back({0.01 * i, 0.1 + 0.005 * i});
    }
    EXPECT_EQ(thin(points, 0.1, 0.02, 1000).points.size(), 2U);
}

}  // namespace
}  // namespace haptoflow::clips
