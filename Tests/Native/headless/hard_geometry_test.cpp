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

TEST(HardGeometryTest, ATipWithNoiseOnAnEdgeOrACornerHasAnOutwardNormalAndNoStrayVelocity) {
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

TEST(HardGeometryTest, ATipWithNoiseInAnInnerCornerStaysOnOneSurface) {
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

TEST(HardGeometryTest, ATipThatPassesThroughAClosedMeshKeepsTouchingAndTurnsItsNormalOnce) {
    const Shape slab = testing::meshOf(testing::rawBoxMesh({0.05, 0.2, 0.2}));
    for (const double offCentreMetres : {0.0, 0.013}) {
        ContactTracker tracker(sceneOf({surfaceOf(slab)}, 0.002));
        const auto readings = play(tracker, sampledPath(1.0, 90.0, [&](double time) {
                                       return glm::dvec3(0.1 * time - 0.05, offCentreMetres, -offCentreMetres);
                                   }));
        int turns = 0;
        for (std::size_t frame = 0; frame < readings.size(); ++frame) {
            ASSERT_TRUE(readings[frame].touching);
            ASSERT_TRUE(isSane(readings[frame]));
            turns += frame > 0 && glm::dot(readings[frame].normal, readings[frame - 1].normal) < 0.99 ? 1 : 0;
        }
        EXPECT_EQ(turns, 1);
        EXPECT_NEAR(readings.front().normal.x, -1.0, 1e-12);
        EXPECT_NEAR(readings.back().normal.x, 1.0, 1e-12);
        EXPECT_EQ(readings.back().touchCounter, 1U);
    }
}

TEST(HardGeometryTest, AMeshWithFlippedRepeatedAndNeedleTrianglesGivesValidReadings) {
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

TEST(HardGeometryTest, AQuaternionIsNormalisedAndAZeroOneIsTheIdentity) {
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

TEST(HardGeometryTest, AnUnusablePoseBecomesTheOriginAndDoesNotAffectOtherSurfaces) {
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

TEST(HardGeometryTest, SizesFromAMicrometreToAThousandKilometresGiveValidReadingsWithDefaultSettings) {
    RandomVectors random(53);
    for (const double scale : {1e-6, 1e6}) {
        const Shape torus = testing::meshOf(testing::rawTorus(scale, 0.4 * scale, 24, 12));
        for (const Shape& shape : {Shape(Box{glm::dvec3(1.0, 2.0, 0.5) * scale}), Shape(Sphere{scale}),
                                   Shape(Capsule{0.4 * scale, 2.0 * scale}), Shape(Plane{}), torus}) {
            ContactTracker tracker(sceneOf({surfaceOf(shape, {random.next() * scale, {0.9, 0.1, 0.3, 0.2}})}));
            for (int frame = 0; frame < 2000; ++frame) {
                const glm::dvec3 tip = 2.0 * scale * random.next();
                ASSERT_TRUE(isSane(tracker.update({frame / 90.0, tip, {}, {}}))) << scale << ", frame " << frame;
            }
            EXPECT_GT(tracker.statistics().touchDowns, 0U) << scale;
        }
    }
}

TEST(HardGeometryTest, ATipWithoutRadiusTouchesWhenItsCentreIsInside) {
    ContactTracker tracker(sceneOf({surfaceOf(Sphere{0.1})}, 0.0));
    EXPECT_FALSE(tracker.update({0.00, {0.0, 0.1001, 0.0}, {}, {}}).touching);
    const ContactReading reading = tracker.update({0.01, {0.0, 0.0999, 0.0}, {}, {}});
    EXPECT_TRUE(reading.touching);
    EXPECT_NEAR(reading.penetrationMetres, 0.0001, 1e-12);
}

}  // namespace
}  // namespace haptoflow::headless
