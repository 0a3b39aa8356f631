#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace haptoflow::headless {
namespace {

using testing::infinity;
using testing::isSane;
using testing::nan;
using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::speedOf;
using testing::surfaceOf;

std::vector<TipSample> strokeOnTable(double seconds = 0.3) {
    return sampledPath(seconds, 90.0, [](double time) { return glm::dvec3(0.2 * time, 0.0, 0.0); });
}

Scene table() {
    return sceneOf({surfaceOf(Plane{})});
}

TEST(HardCasesTest, EveryReadingIsFiniteForAnyMixOfInvalidNumbers) {
    std::mt19937 random(8);
    const std::vector<double> numbers{0.0, -0.0, 1e-320, 1e-9,  0.001,  0.1, -0.1,     1.0,
                                      1e6, 1e12, 1e13,   1e300, -1e300, nan, infinity, -infinity};
    const auto pick = [&] { return numbers[random() % numbers.size()]; };
    SceneSurface broken = surfaceOf(Sphere{0.1}, {{nan, 0.0, 0.0}, {nan, 0.0, 0.0, 0.0}});
    broken.grain = {nan, infinity, 0.0};
    SceneSurface zeroRotation = surfaceOf(Box{{0.2, 0.2, 0.2}}, {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 0.0}});
    zeroRotation.stiffnessNewtonsPerMetre = nan;
    const SceneSurface mesh = surfaceOf(testing::meshOf(testing::rawTorus(0.1, 0.04, 24, 12)));
    ContactTracker tracker(sceneOf({broken, zeroRotation, mesh, surfaceOf(Capsule{0.1, 0.4})}, 0.01));
    for (int frame = 0; frame < 50000; ++frame) {
        const bool mostlyValid = random() % 2 == 0;
        const double time = mostlyValid ? frame / 90.0 : pick();
        TipSample sample{time, {pick(), pick(), pick()}, std::nullopt, glm::dquat(nan, nan, nan, nan)};
        if (random() % 2 == 0) {
            sample.forceNewtons = pick();
        }
        ASSERT_TRUE(isSane(tracker.update(sample))) << "frame " << frame;
    }
    EXPECT_GT(tracker.statistics().sanitisedSamples, 1000U);
    EXPECT_GT(tracker.statistics().touchDowns, 10U);
}

TEST(HardCasesTest, TimeThatStandsStillKeepsTheVelocity) {
    ContactTracker tracker(table());
    const auto samples = strokeOnTable();
    play(tracker, samples);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const ContactReading reading =
            tracker.update({samples.back().timeSeconds, samples.back().positionMetres + 1e-4, {}, {}});
        EXPECT_NEAR(speedOf(reading), 0.2, 1e-9);
    }
}

TEST(HardCasesTest, AMicrosecondBetweenSamplesCausesNoBurstOfSpeed) {
    ContactTracker tracker(table());
    std::vector<TipSample> samples = strokeOnTable();
    for (std::size_t frame = 4; frame + 1 < samples.size(); frame += 4) {
        samples[frame].timeSeconds = samples[frame - 1].timeSeconds + 1e-6;
    }
    for (const ContactReading& reading : play(tracker, samples)) {
        EXPECT_LT(speedOf(reading), 0.35);
    }
    EXPECT_EQ(tracker.statistics().teleports, 0U);
}

TEST(HardCasesTest, TimeThatGoesBackwardsRestartsTheClockOnce) {
    ContactTracker tracker(table());
    play(tracker, strokeOnTable());
    const auto again = play(tracker, strokeOnTable());
    EXPECT_EQ(tracker.statistics().clockRestarts, 1U);
    EXPECT_DOUBLE_EQ(speedOf(again.front()), 0.0);
    EXPECT_NEAR(speedOf(again.back()), 0.2, 1e-9);
}

TEST(HardCasesTest, APauseOfTenSecondsDropsTheHistory) {
    ContactTracker tracker(table());
    play(tracker, strokeOnTable());
    auto later = strokeOnTable();
    for (TipSample& sample : later) {
        sample.timeSeconds += 10.3;
        sample.positionMetres.x += 1.0;
    }
    const auto readings = play(tracker, later);
    EXPECT_DOUBLE_EQ(speedOf(readings.front()), 0.0);
    EXPECT_NEAR(speedOf(readings[1]), 0.2, 1e-9);
    EXPECT_EQ(tracker.statistics().teleports, 0U);
}

TEST(HardCasesTest, ATeleportIsCountedAndCausesNoVelocity) {
    ContactTracker tracker(table());
    auto samples = strokeOnTable(0.6);
    for (std::size_t frame = 27; frame < samples.size(); ++frame) {
        samples[frame].positionMetres += glm::dvec3(3.0, 0.0, -2.0);
    }
    const auto readings = play(tracker, samples);
    EXPECT_EQ(tracker.statistics().teleports, 1U);
    EXPECT_DOUBLE_EQ(speedOf(readings[27]), 0.0);
    for (const ContactReading& reading : readings) {
        EXPECT_LT(speedOf(reading), 0.2 + 1e-9);
    }
    EXPECT_NEAR(speedOf(readings.back()), 0.2, 1e-9);
}

TEST(HardCasesTest, UnusablePositionsKeepTheTipBrieflyAndThenEndTheTouch) {
    ContactTracker tracker(table());
    const auto samples = strokeOnTable();
    play(tracker, samples);
    const double last = samples.back().timeSeconds;
    const ContactReading held = tracker.update({last + 0.02, {nan, 0.0, 0.0}, {}, {}});
    EXPECT_TRUE(held.touching);
    EXPECT_NEAR(speedOf(held), 0.2, 1e-9);
    EXPECT_FALSE(tracker.update({last + 0.11, {0.0, infinity, 0.0}, {}, {}}).touching);
    const ContactReading back = tracker.update({last + 0.12, samples.back().positionMetres, {}, {}});
    EXPECT_TRUE(back.touching);
    EXPECT_DOUBLE_EQ(speedOf(back), 0.0);
    EXPECT_EQ(back.touchCounter, 2U);
    EXPECT_EQ(tracker.statistics().sanitisedSamples, 2U);
}

TEST(HardCasesTest, AStrokeOfNaNNeverTouches) {
    ContactTracker tracker(table());
    for (int frame = 0; frame < 10; ++frame) {
        const ContactReading reading = tracker.update({nan, {nan, nan, nan}, nan, {}});
        EXPECT_TRUE(isSane(reading));
        EXPECT_FALSE(reading.touching);
    }
}

TEST(HardCasesTest, ScenesFromAMicrometreToAThousandKilometresGiveTheSameScaledState) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        Scene scene = sceneOf({surfaceOf(Box{glm::dvec3(2.0) * scale})}, 0.1 * scale);
        ContactSettings settings;
        settings.releaseDistanceMetres *= scale;
        settings.switchMarginMetres *= scale;
        settings.velocity.maximumSpeedMps *= scale;
        settings.velocity.minimumMoveMetres *= scale;
        settings.maximumForceNewtons *= scale;
        ContactTracker tracker(scene, settings);
        const auto readings = play(
            tracker, sampledPath(0.3, 90.0, [&](double time) { return scale * glm::dvec3(0.2 * time, 1.099, 0.0); }));
        EXPECT_NEAR(speedOf(readings.back()), 0.2 * scale, 1e-9 * scale);
        EXPECT_NEAR(readings.back().penetrationMetres, 0.001 * scale, 1e-9 * scale);
        EXPECT_NEAR(readings.back().forceNewtons, 0.5 * scale, 1e-6 * scale);
    }
}

TEST(HardCasesTest, ATipInTheCentreOfEachShapeTouchesWithAUnitNormal) {
    const auto mesh = testing::meshOf(testing::rawBoxMesh({0.1, 0.1, 0.1}));
    for (const Shape& shape :
         {Shape(Box{{0.2, 0.2, 0.2}}), Shape(Sphere{0.1}), Shape(Capsule{0.1, 0.4}), Shape(mesh)}) {
        ContactTracker tracker(sceneOf({surfaceOf(shape)}));
        for (int frame = 0; frame < 20; ++frame) {
            const ContactReading reading = tracker.update({frame / 90.0, glm::dvec3(0.0), {}, {}});
            EXPECT_TRUE(reading.touching);
            EXPECT_TRUE(isSane(reading));
            EXPECT_NEAR(reading.penetrationMetres, 0.101, 1e-9);
        }
    }
}

}  // namespace
}  // namespace haptoflow::headless
