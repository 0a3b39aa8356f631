#include "headless/contact_tracker.hpp"

#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::headless {
namespace {

using testing::play;
using testing::sampledPath;
using testing::sceneOf;
using testing::surfaceOf;

constexpr double penRadius = 0.002;
constexpr glm::dquat level{1.0, 0.0, 0.0, 0.0};

/// A box of this size as every kind that can be one.
std::vector<std::pair<std::string, Shape>> kindsOf(const glm::dvec3& size) {
    return {{"box", Box{size}}, {"mesh", testing::meshOf(testing::rawBoxMesh(0.5 * size))}};
}

/// A table whose top is y = 0, as every kind.
std::vector<std::pair<std::string, SceneSurface>> tables() {
    std::vector<std::pair<std::string, SceneSurface>> tables{{"plane", surfaceOf(Plane{})}};
    for (const auto& [kind, shape] : kindsOf({0.6, 0.04, 0.6})) {
        tables.emplace_back(kind, surfaceOf(shape, {{0.0, -0.02, 0.0}, level}));
    }
    return tables;
}

/// Visits mats of every kind and thickness on tables of every kind: the mat is surface 1.
template <typename Visit>
void forEachMat(Visit&& visit) {
    for (const double thickMetres : {0.0001, 0.001, 0.003, 0.005}) {
        for (const auto& [kind, shape] : kindsOf({0.2, thickMetres, 0.2})) {
            for (const auto& [tableKind, table] : tables()) {
                SCOPED_TRACE(kind + " of " + std::to_string(1000.0 * thickMetres) + " mm on a " + tableKind);
                const SceneSurface mat = surfaceOf(shape, {{0.0, 0.5 * thickMetres, 0.0}, level});
                visit(sceneOf({table, mat}, penRadius), thickMetres);
            }
        }
    }
}

TEST(KindsOfShapeTest, AMatOnATableStaysAMatHoweverDeepTheHandIs) {
    forEachMat([](const Scene& scene, double thickMetres) {
        for (const double deepMetres : {0.004, 0.012, 0.03}) {
            for (const double pressSeconds : {0.05, 1.0}) {
                ContactTracker tracker(scene);
                const auto readings =
                    play(tracker, sampledPath(2.0, 90.0, [&](double time) {
                             const double depth = deepMetres * std::min(1.0, time / pressSeconds);
                             return glm::dvec3(0.05 * std::cos(4.0 * time), thickMetres + penRadius + 0.0005 - depth,
                                               0.05 * std::sin(4.0 * time));
                         }));
                for (const ContactReading& reading : readings) {
                    ASSERT_TRUE(!reading.touching || reading.surfaceIndex == 1) << reading.timeSeconds;
                }
                EXPECT_TRUE(readings.back().touching);
                EXPECT_EQ(readings.back().touchCounter, 1U);
                EXPECT_EQ(readings.back().landingCounter + readings.back().edgeCounter, 0U);
                EXPECT_NEAR(readings.back().penetrationMetres, deepMetres - 0.0005, 1e-9);
                EXPECT_NEAR(readings.back().normal.y, 1.0, 1e-9);
            }
        }
    });
}

TEST(KindsOfShapeTest, ATipThatSlidesOffTheMatTouchesTheTableInTheSameTouch) {
    forEachMat([](const Scene& scene, double thickMetres) {
        for (const double deepMetres : {0.0065, 0.012, 0.02}) {
            ContactTracker tracker(scene);
            const auto readings = play(tracker, sampledPath(2.0, 90.0, [&](double time) {
                                           const double depth = deepMetres * std::min(1.0, 2.0 * time);
                                           return glm::dvec3(0.1 * time, thickMetres + penRadius + 0.0005 - depth, 0.0);
                                       }));
            EXPECT_EQ(readings[80].surfaceIndex, 1);
            EXPECT_EQ(readings.back().surfaceIndex, 0);
            EXPECT_EQ(readings.back().touchCounter, 1U);
        }
    });
}

TEST(KindsOfShapeTest, ATipThatPassesThroughAPlateInTheAirLeavesItAndIsFeltAgainFromBelow) {
    for (const auto& [kind, shape] : kindsOf({0.1, 0.003, 0.1})) {
        SCOPED_TRACE(kind);
        ContactTracker tracker(sceneOf({surfaceOf(shape)}, penRadius));
        const auto readings =
            play(tracker, sampledPath(2.0, 90.0, [](double time) {
                     return glm::dvec3(0.02 * time, std::max(0.006 - 0.02 * time, -0.03 + 0.016 * time), 0.0);
                 }));
        bool hasLeft = false;
        for (const ContactReading& reading : readings) {
            const double below = -0.0015 - (reading.timeSeconds < 1.0 ? 0.006 - 0.02 * reading.timeSeconds : 0.0);
            hasLeft = hasLeft || below > penRadius + 0.0005;
            if (reading.touching && !hasLeft) {
                EXPECT_NEAR(reading.normal.y, 1.0, 1e-9) << reading.timeSeconds;
            }
            if (hasLeft && reading.timeSeconds < 1.0) {
                EXPECT_FALSE(reading.touching) << reading.timeSeconds;
            }
        }
        EXPECT_TRUE(hasLeft);
        EXPECT_EQ(readings.back().touchCounter, 2U);
        EXPECT_NEAR(readings.back().normal.y, -1.0, 1e-9);
    }
}

TEST(KindsOfShapeTest, ABoxAndItsMeshGiveTheSameReadingsOnRandomStrokes) {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    int touches = 0;
    for (int round = 0; round < 60; ++round) {
        const glm::dvec3 size(between(0.002, 0.06), between(0.002, 0.06), between(0.002, 0.06));
        const Pose pose{{0.0, 0.0, 0.0}, testing::turned(between(0.0, 180.0), {between(-1, 1), between(-1, 1), 1.0})};
        const auto kinds = kindsOf(size);
        ContactTracker box(sceneOf({surfaceOf(kinds[0].second, pose)}, penRadius));
        ContactTracker mesh(sceneOf({surfaceOf(kinds[1].second, pose)}, penRadius));
        glm::dvec3 tip = 0.05 * glm::dvec3(1.0, 1.0, 1.0);
        glm::dvec3 aim = tip;
        for (int frame = 0; frame < 600; ++frame) {
            if (frame % 20 == 0) {
                aim = size * glm::dvec3(between(-0.8, 0.8), between(-0.8, 0.8), between(-0.8, 0.8));
            }
            tip += 0.07 * (aim - tip);
            const TipSample sample{frame / 90.0, pose.pointToWorld(tip), {}, {}};
            const ContactReading ofBox = box.update(sample);
            const ContactReading ofMesh = mesh.update(sample);
            ASSERT_EQ(ofBox.touching, ofMesh.touching) << "round " << round << ", frame " << frame;
            touches += ofBox.touching ? 1 : 0;
            ASSERT_NEAR(ofBox.penetrationMetres, ofMesh.penetrationMetres, 1e-9)
                << "round " << round << ", frame " << frame;
            ASSERT_LT(glm::distance(ofBox.normal, ofMesh.normal), 1e-6) << "round " << round << ", frame " << frame;
        }
    }
    EXPECT_GT(touches, 5000);
}

TEST(KindsOfShapeTest, EveryFastPassThroughAThinObjectIsOneTouchOfItsSpeed) {
    std::vector<std::pair<std::string, Shape>> kinds = kindsOf({0.1, 0.003, 0.1});
    kinds.emplace_back("ball", Sphere{0.01});
    kinds.emplace_back("rod", Capsule{0.005, 0.06});
    kinds.emplace_back("plane", Plane{});
    for (const auto& [kind, shape] : kinds) {
        for (const auto& [speed, rateHz] : {std::pair(3.0, 10.0), {3.0, 72.0}, {1.0, 30.0}}) {
            int touched = 0;
            for (int pass = 0; pass < 20; ++pass) {
                // Lying, so that the rod is passed across.
                const Pose pose{{0.0, 0.0, 0.0}, testing::turned(90.0, {1.0, 0.0, 0.0})};
                ContactTracker tracker(sceneOf({surfaceOf(shape, kind == "rod" ? pose : Pose{})}, penRadius));
                const double offset = speed / rateHz * pass / 20.0;
                const auto readings = play(tracker, sampledPath(1.0, rateHz, [&](double time) {
                                               return glm::dvec3(0.0002, 0.5 * speed + offset - speed * time, 0.0001);
                                           }));
                touched += readings.back().touchCounter == 1 ? 1 : 0;
                const auto first = std::ranges::find_if(readings, [](const auto& each) { return each.touching; });
                if (first != readings.end()) {
                    EXPECT_NEAR(first->approachSpeedMps, speed, 0.05 * speed) << kind;
                    EXPECT_GT(first->normal.y, 0.99) << kind;
                }
            }
            EXPECT_EQ(touched, 20) << kind << " at " << speed << " m/s and " << rateHz << " Hz";
        }
    }
}

TEST(KindsOfShapeTest, OfTwoPlatesThatATipPassesTheFirstIsTouched) {
    for (const int upper : {0, 1}) {
        std::vector<SceneSurface> plates(2, surfaceOf(Box{{0.1, 0.002, 0.1}}));
        plates[static_cast<std::size_t>(upper)].pose.positionMetres.y = 0.03;
        ContactTracker tracker(sceneOf(plates, penRadius));
        tracker.update({0.0, {0.0, 0.15, 0.0}, {}, {}});
        EXPECT_EQ(tracker.update({0.1, {0.0, -0.15, 0.0}, {}, {}}).surfaceIndex, upper);
    }
}

TEST(KindsOfShapeTest, APassIsThatOfTheTipInTheSurfacesOwnFrame) {
    for (const double mps : {0.0, 3.0, 20.0}) {
        SceneSurface lift = surfaceOf(Box{{0.1, 0.003, 0.1}});
        lift.motion.emplace(
            std::vector<Keyframe>{{0.0, {{0.0, 0.0, 0.0}, level}}, {2.0, {{0.0, 2.0 * mps, 0.0}, level}}}, false);
        for (const double height : {0.005, -0.005}) {
            ContactTracker resting(sceneOf({lift}, penRadius));
            for (const ContactReading& reading : play(resting, sampledPath(1.0, 90.0, [&](double time) {
                                                          return glm::dvec3(0.0, mps * time + height, 0.0);
                                                      }))) {
                ASSERT_FALSE(reading.touching) << mps;
            }
        }
    }
    // A plate that is swung through a tip at rest is met, too.
    SceneSurface swung = surfaceOf(Box{{0.1, 0.003, 0.1}});
    swung.motion.emplace(std::vector<Keyframe>{{0.0, {{0.0, -1.51, 0.0}, level}}, {1.0, {{0.0, 1.49, 0.0}, level}}},
                         false);
    ContactTracker tracker(sceneOf({swung}, penRadius));
    EXPECT_EQ(play(tracker, sampledPath(1.0, 20.0, [](double) { return glm::dvec3(0.0); })).back().touchCounter, 1U);
}

TEST(KindsOfShapeTest, ATeleportAPauseAndARestartedClockPassNothing) {
    for (const double jumpSeconds : {0.005, 0.4, -0.1}) {
        ContactTracker tracker(sceneOf({surfaceOf(Box{{0.1, 0.003, 0.1}})}, penRadius));
        tracker.update({1.0, {0.0, 0.15, 0.0}, {}, {}});
        EXPECT_FALSE(tracker.update({1.0 + jumpSeconds, {0.0, -0.15, 0.0}, {}, {}}).touching) << jumpSeconds;
    }
}

}  // namespace
}  // namespace haptoflow::headless
