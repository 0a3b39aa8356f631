#include "headless/contact_tracker.hpp"

#include "support/counting_new.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

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

/// Position of the centre of a 1 mm tip that is pressed `depth` into a table at y = 0.
glm::dvec3 pressed(double depth, double x = 0.0) {
    return {x, 0.001 - depth, 0.0};
}

TEST(ContactTrackerTest, TouchBeginsAtPenetrationAndEndsBeyondTheReleaseDistance) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    auto touchingAt = [&, time = 0.0](double depth) mutable {
        time += 0.01;
        return tracker.update({time, pressed(depth), {}, {}}).touching;
    };
    EXPECT_FALSE(touchingAt(-0.0003));
    EXPECT_FALSE(touchingAt(0.0));
    EXPECT_TRUE(touchingAt(0.0001));
    EXPECT_TRUE(touchingAt(-0.0004));
    EXPECT_FALSE(touchingAt(-0.0006));
    EXPECT_FALSE(touchingAt(-0.0004));
}

TEST(ContactTrackerTest, SpringForceIsStiffnessTimesDepthUpToTheMaximum) {
    Scene scene = sceneOf({surfaceOf(Plane{})});
    scene.surfaces[0].stiffnessNewtonsPerMetre = 800.0;
    ContactTracker tracker(scene);
    EXPECT_NEAR(tracker.update({0.0, pressed(0.002), {}, {}}).forceNewtons, 1.6, 1e-12);
    EXPECT_DOUBLE_EQ(tracker.update({0.01, pressed(0.5), {}, {}}).forceNewtons, 5.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.02, pressed(-0.0002), {}, {}}).forceNewtons, 0.0);
}

TEST(ContactTrackerTest, AMeasuredForceReplacesTheSpringForceWhileTouching) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    EXPECT_DOUBLE_EQ(tracker.update({0.00, pressed(0.002), 0.7, {}}).forceNewtons, 0.7);
    EXPECT_DOUBLE_EQ(tracker.update({0.01, pressed(0.002), 70.0, {}}).forceNewtons, 5.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.02, pressed(0.002), -1.0, {}}).forceNewtons, 0.0);
    EXPECT_DOUBLE_EQ(tracker.update({0.03, pressed(-0.1), 0.7, {}}).forceNewtons, 0.0);
    EXPECT_NEAR(tracker.update({0.04, pressed(0.002), {}, {}}).forceNewtons, 1.0, 1e-12);
}

TEST(ContactTrackerTest, StiffnessComesFromTheSurfaceThenItsLabelsThenTheDefault) {
    Scene scene = sceneOf({surfaceOf(Plane{})});
    ContactSettings settings;
    settings.defaultStiffnessNewtonsPerMetre = 300.0;
    settings.stiffnessOfLabel = [](std::string_view label) -> std::optional<double> {
        return label == "wood" ? std::optional(1000.0) : label == "cork" ? std::optional(500.0) : std::nullopt;
    };
    const auto forceOf = [&] {
        return ContactTracker(scene, settings).update({0.0, pressed(0.001), {}, {}}).forceNewtons;
    };
    scene.surfaces[0].material = {{"wood", 0.25}, {"cork", 0.75}};
    EXPECT_NEAR(forceOf(), 0.625, 1e-12);
    scene.surfaces[0].material = {{"wood", 0.5}, {"unknown", 0.5}};
    EXPECT_NEAR(forceOf(), 1.0, 1e-12);
    scene.surfaces[0].material = {{"unknown", 1.0}};
    EXPECT_NEAR(forceOf(), 0.3, 1e-12);
    scene.surfaces[0].stiffnessNewtonsPerMetre = 2000.0;
    EXPECT_NEAR(forceOf(), 2.0, 1e-12);
}

TEST(ContactTrackerTest, ApproachSpeedIsConstantDuringATouch) {
    ContactTracker tracker(sceneOf({surfaceOf(Plane{})}));
    const auto readings = play(tracker, sampledPath(0.6, 120.0, [](double time) {
                                   return glm::dvec3(0.05 * time, std::max(0.0, 0.05 - 0.4 * time), 0.0);
                               }));
    const auto down =
        std::find_if(readings.begin(), readings.end(), [](const auto& reading) { return reading.touching; });
    ASSERT_NE(down, readings.end());
    EXPECT_NEAR(down->approachSpeedMps, 0.4, 0.01);
    EXPECT_DOUBLE_EQ(readings.front().approachSpeedMps, 0.0);
    EXPECT_DOUBLE_EQ(readings.back().approachSpeedMps, down->approachSpeedMps);
}

TEST(ContactTrackerTest, TheDeepestContactWinsUntilAnotherIsDeeperByTheMargin) {
    const SceneSurface left = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{-0.05, -0.05, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    SceneSurface right = surfaceOf(Box{{0.1, 0.1, 0.1}}, {{0.05, -0.0497, 0.0}, {1.0, 0.0, 0.0, 0.0}});
    ContactTracker tracker(sceneOf({left, right}));
    EXPECT_EQ(tracker.update({0.00, pressed(0.0005, -0.02), {}, {}}).surfaceIndex, 0);
    EXPECT_EQ(tracker.update({0.01, pressed(0.0005, -0.0002), {}, {}}).surfaceIndex, 0);
    EXPECT_EQ(tracker.update({0.02, pressed(0.0005, 0.02), {}, {}}).surfaceIndex, 1);
    EXPECT_EQ(tracker.update({0.03, pressed(0.0005, 0.0002), {}, {}}).surfaceIndex, 1);
    EXPECT_EQ(tracker.update({0.04, pressed(0.0005, 0.0002), {}, {}}).touchCounter, 1U);
}

TEST(ContactTrackerTest, CrossingABoxEdgeRollsTheNormalOverInsteadOfFlippingIt) {
    ContactTracker tracker(sceneOf({surfaceOf(Box{{0.1, 0.1, 0.1}})}, 0.005));
    // Over the top, around the edge at a depth of 0.5 mm, down the side.
    const auto readings = play(tracker, sampledPath(1.0, 240.0, [](double time) {
                                   const double path = 0.04 * time - 0.02;
                                   const double arc = 0.0045 * std::numbers::pi / 2.0;
                                   const double angle = std::clamp(path / 0.0045, 0.0, std::numbers::pi / 2.0);
                                   return glm::dvec3(0.05 + std::min(0.0, path) + 0.0045 * std::sin(angle),
                                                     0.05 + 0.0045 * std::cos(angle) - std::max(0.0, path - arc), 0.0);
                               }));
    for (std::size_t frame = 1; frame < readings.size(); ++frame) {
        ASSERT_TRUE(readings[frame].touching);
        EXPECT_LT(testing::degreesBetween(readings[frame].normal, readings[frame - 1].normal), 2.5);
    }
    EXPECT_NEAR(readings.front().normal.y, 1.0, 1e-12);
    EXPECT_NEAR(readings.back().normal.x, 1.0, 1e-12);
}

TEST(ContactTrackerTest, ATipThatPassesThroughAClosedMeshKeepsTouchingAndTurnsItsNormalOnce) {
    const Shape slab = testing::meshOf(testing::rawBoxMesh({0.05, 0.2, 0.2}));
    for (const double offCentreMetres : {0.0, 0.013}) {
        ContactTracker tracker(sceneOf({surfaceOf(slab)}, 0.002));
        const auto readings = play(tracker, sampledPath(1.0, 90.0, [&](double time) {
                                       return glm::dvec3(0.1 * time - 0.05, offCentreMetres, -offCentreMetres);
                                   }));
        int cycles = 0;
        for (std::size_t frame = 0; frame < readings.size(); ++frame) {
            ASSERT_TRUE(readings[frame].touching);
            ASSERT_TRUE(isSane(readings[frame]));
            cycles += frame > 0 && glm::dot(readings[frame].normal, readings[frame - 1].normal) < 0.99 ? 1 : 0;
        }
        EXPECT_EQ(cycles, 1);
        EXPECT_NEAR(readings.front().normal.x, -1.0, 1e-12);
        EXPECT_NEAR(readings.back().normal.x, 1.0, 1e-12);
        EXPECT_EQ(readings.back().touchCounter, 1U);
    }
}

TEST(ContactTrackerTest, NoFrameOfContactAllocates) {
    std::vector<SceneSurface> surfaces{surfaceOf(Plane{}, {{0.0, -0.1, 0.0}, {1.0, 0.0, 0.0, 0.0}})};
    const std::vector<Shape> shapes{Box{glm::dvec3(0.03)}, Sphere{0.02}, Capsule{0.01, 0.05},
                                    testing::meshOf(testing::rawTorus(0.03, 0.01, 16, 8))};
    for (int index = 0; index < 40; ++index) {
        const Pose pose{{0.02 * index, 0.0, 0.0}, testing::turned(30.0 * index, {1.0, 2.0, 3.0})};
        surfaces.push_back(surfaceOf(shapes[static_cast<std::size_t>(index) % shapes.size()], pose));
        if (index % 5 == 0) {
            const Pose away{{0.02 * index, 0.05, 0.02}, pose.rotation};
            surfaces.back().motion.emplace(std::vector<Keyframe>{{0.0, pose}, {0.3, away}, {1.0, pose}}, true);
        }
    }
    const auto stroke = sampledPath(10.0, 90.0, [](double time) {
        const double x = std::fmod(0.3 * time, 0.8);  // a jump each time round
        return glm::dvec3(x, 0.03 * std::sin(20.0 * time), 0.01 * std::cos(7.0 * time));
    });
    ContactTracker tracker(sceneOf(surfaces));
    const std::size_t before = haptoflow::testing::allocationCount();
    for (const TipSample& sample : stroke) {
        tracker.update(sample);
    }
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
    EXPECT_GT(tracker.statistics().touchDowns, 20U);
    EXPECT_GT(tracker.statistics().teleports, 0U);
    const std::vector<double> proof(10);
    EXPECT_GT(haptoflow::testing::allocationCount(), before) << "the counter does not work";
}

std::vector<TipSample> strokeOnTable(double seconds = 0.3) {
    return sampledPath(seconds, 90.0, [](double time) { return glm::dvec3(0.2 * time, 0.0, 0.0); });
}

Scene table() {
    return sceneOf({surfaceOf(Plane{})});
}

TEST(ContactTrackerTest, EveryReadingIsFiniteForAnyMixOfInvalidNumbers) {
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

TEST(ContactTrackerTest, TimeThatStandsStillKeepsTheVelocity) {
    ContactTracker tracker(table());
    const auto samples = strokeOnTable();
    play(tracker, samples);
    for (int repeat = 0; repeat < 100; ++repeat) {
        const ContactReading reading =
            tracker.update({samples.back().timeSeconds, samples.back().positionMetres + 1e-4, {}, {}});
        EXPECT_NEAR(speedOf(reading), 0.2, 1e-9);
    }
}

TEST(ContactTrackerTest, AClockThatRestartsAPauseAndATeleportDropTheHistory) {
    struct Break {
        double seconds;
        glm::dvec3 metres;
        std::uint64_t clockRestarts;
        std::uint64_t teleports;
    };
    for (const Break& after :
         {Break{-0.3, {-0.06, 0.0, 0.0}, 1, 0}, {10.0, {1.0, 0.0, 0.0}, 0, 0}, {0.0, {3.0, 0.0, -2.0}, 0, 1}}) {
        SCOPED_TRACE(after.seconds);
        ContactTracker tracker(table());
        auto samples = strokeOnTable(0.6);
        for (std::size_t frame = 27; frame < samples.size(); ++frame) {
            samples[frame].timeSeconds += after.seconds;
            samples[frame].positionMetres += after.metres;
        }
        const auto readings = play(tracker, samples);
        EXPECT_EQ(tracker.statistics().clockRestarts, after.clockRestarts);
        EXPECT_EQ(tracker.statistics().teleports, after.teleports);
        EXPECT_DOUBLE_EQ(speedOf(readings[27]), 0.0);
        for (const ContactReading& reading : readings) {
            EXPECT_LT(speedOf(reading), 0.2 + 1e-9);
        }
        EXPECT_NEAR(speedOf(readings[28]), 0.2, 1e-9);
        EXPECT_NEAR(speedOf(readings.back()), 0.2, 1e-9);
    }
}

TEST(ContactTrackerTest, UnusablePositionsKeepTheTipBrieflyAndThenEndTheTouch) {
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

class RandomVectors {
public:
    explicit RandomVectors(std::uint32_t seed) : random_(seed) {}
    /// A random vector with coordinates between -1 and 1.
    glm::dvec3 next() {
        const double x = spread_(random_);
        const double y = spread_(random_);
        return {x, y, spread_(random_)};
    }

private:
    std::mt19937 random_;
    std::uniform_real_distribution<double> spread_{-1.0, 1.0};
};

TEST(ContactTrackerTest, ATipWithNoiseOnAnEdgeOrACornerHasAnOutwardNormalAndNoStrayVelocity) {
    RandomVectors random(41);
    const Shape mesh = testing::meshOf(testing::rawBoxMesh({0.1, 0.1, 0.1}));
    for (const Shape& shape : {Shape(Box{{0.2, 0.2, 0.2}}), mesh}) {
        for (const glm::dvec3& place : {glm::dvec3(0.1, 0.1, 0.03), {0.1, -0.1, 0.1}}) {
            for (const double trembleMetres : {0.0, 1e-15, 1e-12, 1e-9, 1e-6}) {
                ContactTracker tracker(sceneOf({surfaceOf(shape)}));
                for (int frame = 0; frame < 200; ++frame) {
                    const ContactReading reading =
                        tracker.update({frame / 90.0, place + trembleMetres * random.next(), {}, {}});
                    ASSERT_TRUE(reading.touching);
                    ASSERT_TRUE(isSane(reading));
                    EXPECT_GT(glm::dot(reading.normal, glm::sign(place)), 0.5);
                    EXPECT_NEAR(reading.penetrationMetres, 0.001, 2.0 * trembleMetres + 1e-12);
                    EXPECT_LE(speedOf(reading), 2.0 * std::sqrt(3.0) * trembleMetres * 90.0);
                }
            }
        }
    }
}

TEST(ContactTrackerTest, ATipWithNoiseInAnInnerCornerStaysOnOneSurface) {
    RandomVectors random(43);
    const SceneSurface wall = surfaceOf(Plane{}, {{0.0, 0.0, 0.0}, testing::turned(-90.0, {0.0, 0.0, 1.0})});
    ContactTracker tracker(sceneOf({surfaceOf(Plane{}), wall}));
    const int first = tracker.update({0.0, {0.0005, 0.0005, 0.0}, {}, {}}).surfaceIndex;
    for (int frame = 1; frame < 500; ++frame) {
        const glm::dvec3 tip = glm::dvec3(0.0005, 0.0005, 0.0) + 0.0002 * random.next();
        const ContactReading reading = tracker.update({frame / 90.0, tip, {}, {}});
        ASSERT_TRUE(reading.touching);
        ASSERT_TRUE(isSane(reading));
        EXPECT_EQ(reading.surfaceIndex, first);
    }
    EXPECT_EQ(tracker.statistics().touchDowns, 1U);
}

TEST(ContactTrackerTest, AMeshWithFlippedRepeatedAndNeedleTrianglesGivesValidReadings) {
    RandomVectors random(47);
    testing::RawMesh raw = testing::rawTorus(0.1, 0.04, 24, 12);
    for (std::size_t index = 0; index < raw.triangles.size(); index += 5) {
        std::swap(raw.triangles[index][0], raw.triangles[index][1]);
    }
    const std::vector<TriangleMesh::Triangle> whole = raw.triangles;
    for (std::size_t index = 0; index < whole.size(); index += 7) {
        const auto [a, b, c] = whole[index];
        const glm::dvec3 middle = 0.5 * (raw.vertices[a] + raw.vertices[b]);
        for (const double width : {0.0, 1e-18, 1e-13, 1e-9}) {
            const auto tip = static_cast<std::uint32_t>(raw.vertices.size());
            raw.vertices.push_back(middle + width * random.next());
            raw.triangles.push_back({a, b, tip});
            raw.triangles.push_back({tip, tip, c});
        }
        raw.triangles.push_back({a, b, c});
        raw.triangles.push_back({a, a, a});
    }
    ContactTracker tracker(sceneOf({surfaceOf(testing::meshOf(raw))}, 0.003));
    glm::dvec3 tip(0.1, 0.0, 0.0);
    for (int frame = 0; frame < 20000; ++frame) {
        tip = glm::clamp(tip + 0.01 * random.next(), glm::dvec3(-0.15, -0.05, -0.15), glm::dvec3(0.15, 0.05, 0.15));
        ASSERT_TRUE(isSane(tracker.update({frame / 90.0, tip, {}, {}}))) << "frame " << frame;
    }
    EXPECT_GT(tracker.statistics().touchDowns, 20U);
}

TEST(ContactTrackerTest, AQuaternionIsNormalisedAndAZeroOneIsTheIdentity) {
    const glm::dquat unit = testing::turned(50.0, {1.0, 2.0, 3.0});
    const glm::dvec3 place(0.2, -0.1, 0.4);
    const auto readingWith = [&](const glm::dquat& pose, const glm::dquat& given) {
        ContactTracker tracker(sceneOf({surfaceOf(Box{{0.1, 0.2, 0.3}}, {place, pose})}));
        return tracker.update({0.0, place + given * glm::dvec3(0.02, 0.1002, 0.07), {}, {}});
    };
    const ContactReading wanted = readingWith(unit, unit);
    ASSERT_TRUE(wanted.touching);
    for (const double length : {1e-150, 0.3, -2.0, 1e150}) {
        const ContactReading reading = readingWith(unit * length, unit);
        ASSERT_TRUE(reading.touching) << length;
        EXPECT_LT(glm::distance(reading.normal, wanted.normal), 1e-12) << length;
        EXPECT_LT(glm::distance(reading.pointMetres, wanted.pointMetres), 1e-12) << length;
        EXPECT_NEAR(reading.penetrationMetres, wanted.penetrationMetres, 1e-12) << length;
    }
    const ContactReading unturned = readingWith({0.0, 0.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0});
    ASSERT_TRUE(unturned.touching);
    EXPECT_LT(glm::distance(unturned.normal, glm::dvec3(0.0, 1.0, 0.0)), 1e-12);
}

TEST(ContactTrackerTest, AnUnusablePoseBecomesTheOriginAndDoesNotAffectOtherSurfaces) {
    const glm::dquat level(1.0, 0.0, 0.0, 0.0);
    const glm::dquat broken(1.0, infinity, 0.0, 0.0);
    const std::vector<Pose> poses{{{nan, 1.0, 1.0}, level},
                                  {{1.0, infinity, 1.0}, level},
                                  {{1.0, 1.0, -infinity}, broken},
                                  {{1e300, 0.0, 0.0}, {nan, nan, nan, nan}}};
    for (const Pose& pose : poses) {
        const SceneSurface resting = surfaceOf(Box{{0.1, 0.2, 0.3}}, pose);
        SceneSurface moving = resting;
        moving.motion.emplace(std::vector<Keyframe>{{0.0, pose}, {1.0, pose}}, false);
        for (const SceneSurface& damaged : {resting, moving}) {
            const SceneSurface sound = surfaceOf(Sphere{0.1}, {{2.0, 0.0, 0.0}, level});
            ContactTracker tracker(sceneOf({damaged, sound}));
            const ContactReading reading = tracker.update({0.0, {0.02, 0.1002, 0.07}, {}, {}});
            EXPECT_EQ(reading.surfaceIndex, 0);
            EXPECT_NEAR(reading.normal.y, 1.0, 1e-12);
            EXPECT_EQ(tracker.update({1.0, {2.0, 0.1002, 0.0}, {}, {}}).surfaceIndex, 1);
        }
    }
}

}  // namespace
}  // namespace haptoflow::headless
