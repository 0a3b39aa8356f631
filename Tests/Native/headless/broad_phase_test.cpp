#include "headless/scene.hpp"

#include "headless/bounds_tree.hpp"
#include "headless/contact_tracker.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace haptoflow::headless {
namespace {

std::vector<std::uint32_t> visited(const BoundsTree& tree, const glm::dvec3& point, double squaredLimit) {
    std::vector<std::uint32_t> items;
    tree.visitNear(point, squaredLimit, [&](std::uint32_t item) {
        items.push_back(item);
        return squaredLimit;
    });
    std::sort(items.begin(), items.end());
    return items;
}

TEST(BoundsTreeTest, EveryBoxWithinTheLimitIsVisitedOnceAndFewOthersAre) {
    std::mt19937 random(29);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const auto anyPoint = [&] { return glm::dvec3(spread(random), spread(random), spread(random)); };
    for (const std::size_t count : {1U, 4U, 5U, 1000U}) {
        std::vector<Bounds> boxes(count);
        for (Bounds& box : boxes) {
            box.include(anyPoint());
            box.include(box.lowest + 0.1 * anyPoint());
        }
        const BoundsTree tree(boxes);
        for (int trial = 0; trial < 300; ++trial) {
            const glm::dvec3 point = anyPoint();
            const double squaredLimit = trial % 2 == 0 ? 0.0 : 0.01;
            const std::vector<std::uint32_t> items = visited(tree, point, squaredLimit);
            EXPECT_EQ(std::adjacent_find(items.begin(), items.end()), items.end());
            for (std::uint32_t item = 0; item < count; ++item) {
                if (boxes[item].squaredDistanceTo(point) <= squaredLimit) {
                    EXPECT_TRUE(std::binary_search(items.begin(), items.end(), item));
                }
            }
            EXPECT_LE(items.size(), 100U);
        }
    }
}

TEST(BoundsTreeTest, IdenticalBoxesAreAllVisited) {
    Bounds box;
    box.include(glm::dvec3(1.0, 2.0, 3.0));
    const std::vector<Bounds> boxes(333, box);
    EXPECT_EQ(visited(BoundsTree(boxes), {1.0, 2.0, 3.0}, 0.0).size(), 333U);
    EXPECT_TRUE(visited(BoundsTree(boxes), {1.0, 2.0, 3.1}, 0.0).empty());
}

TEST(BoundsTreeTest, ATreeWithoutItemsVisitsNone) {
    EXPECT_TRUE(visited(BoundsTree(), glm::dvec3(0.0), 1e300).empty());
    EXPECT_TRUE(visited(BoundsTree(std::vector<Bounds>()), glm::dvec3(0.0), 1e300).empty());
}

using testing::sceneOf;
using testing::surfaceOf;

/// Spheres of 10 mm every 50 mm over a square table; each moves by `swingMetres` to either side, twice per second.
Scene gridOfSpheres(int perSide, double swingMetres = 0.0) {
    std::vector<SceneSurface> surfaces;
    for (int row = 0; row < perSide; ++row) {
        for (int column = 0; column < perSide; ++column) {
            const Pose home{{0.05 * column, 0.0, 0.05 * row}, {1.0, 0.0, 0.0, 0.0}};
            surfaces.push_back(surfaceOf(Sphere{0.01}, home));
            if (swingMetres > 0.0) {
                Pose left = home;
                Pose right = home;
                left.positionMetres.x -= swingMetres;
                right.positionMetres.x += swingMetres;
                surfaces.back().motion.emplace(std::vector<Keyframe>{{0.0, left}, {0.25, right}, {0.5, left}}, true);
            }
        }
    }
    return sceneOf(std::move(surfaces));
}

/// A small box mesh far from its own origin.
SceneSurface farFromItsOrigin(const glm::dvec3& offsetMetres) {
    testing::RawMesh raw = testing::rawBoxMesh(glm::dvec3(0.01));
    for (glm::dvec3& vertex : raw.vertices) {
        vertex += offsetMetres;
    }
    return surfaceOf(testing::meshOf(raw));
}

bool visits(const BroadPhase& broadPhase, const glm::dvec3& tip) {
    int visits = 0;
    broadPhase.visitNear(tip, [&](std::size_t) { ++visits; });
    return visits == 1;
}

TEST(BroadPhaseTest, RoundingHidesNoSurfaceAtTheLimitOfItsReach) {
    std::mt19937 random(23);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const auto anyVector = [&] { return glm::dvec3(spread(random), spread(random), spread(random)); };
    constexpr double reach = 0.002;
    int within = 0;
    int beyond = 0;
    for (int trial = 0; trial < 3000; ++trial) {
        SceneSurface surface = farFromItsOrigin(100.0 * anyVector());
        surface.pose = {anyVector(), testing::turned(180.0 * spread(random), anyVector())};
        const BroadPhase broadPhase({surface}, reach);
        const BoundingSphere sphere = boundingSphere(surface.shape);
        glm::dvec3 out(0.0);
        out[trial % 3] = sphere.radiusMetres + reach + 1e-13 * spread(random);
        const Pose pose = sanitised(surface.pose);
        const glm::dvec3 tip = pose.pointToWorld(sphere.centreMetres) + (trial % 2 == 0 ? out : -out);
        const bool reaches = broadPhase.reaches(0, pose.pointToLocal(tip));
        EXPECT_TRUE(!reaches || visits(broadPhase, tip)) << "trial " << trial;
        (reaches ? within : beyond) += 1;
    }
    EXPECT_GT(within, 500);
    EXPECT_GT(beyond, 500);
}

TEST(BroadPhaseTest, ASurfaceIsVisitedAlongItsWholePathWhateverItsRotation) {
    std::mt19937 random(61);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const auto anyVector = [&] { return glm::dvec3(spread(random), spread(random), spread(random)); };
    const auto anyPose = [&] { return Pose{anyVector(), testing::turned(180.0 * spread(random), anyVector())}; };
    for (int trial = 0; trial < 200; ++trial) {
        SceneSurface surface = farFromItsOrigin(anyVector());
        surface.motion.emplace(std::vector<Keyframe>{{0.0, anyPose()}, {0.3, anyPose()}, {1.0, anyPose()}}, false);
        const BroadPhase broadPhase({surface}, 0.002);
        const BoundingSphere sphere = boundingSphere(surface.shape);
        for (int step = -5; step <= 105; ++step) {
            const glm::dvec3 centre = surface.poseAt(0.01 * step).pointToWorld(sphere.centreMetres);
            const glm::dvec3 direction = glm::normalize(anyVector());
            EXPECT_TRUE(visits(broadPhase, centre + 0.999 * (sphere.radiusMetres + 0.002) * direction));
        }
    }
}

TEST(BroadPhaseTest, ATipOverTenThousandSeparateSurfacesQueriesOnlyAFewAtRestOrMoving) {
    for (const double swingMetres : {0.0, 0.02}) {
        ContactTracker tracker(gridOfSpheres(100, swingMetres));
        std::set<int> touched;
        ContactStatistics before;
        for (int frame = 0; frame < 1000; ++frame) {
            const double along = 0.005 * frame;
            touched.insert(tracker.update({frame / 90.0, {along, 0.0105, 0.9 * along}, {}, {}}).surfaceIndex);
            const ContactStatistics& now = tracker.statistics();
            EXPECT_LE(now.surfaceQueries - before.surfaceQueries, 2U);
            EXPECT_LE(now.surfacesRuledOut - before.surfacesRuledOut, 16U);
            before = now;
        }
        EXPECT_GT(touched.size(), 10U);
    }
}

TEST(BroadPhaseTest, AThousandSurfacesInTheSamePlaceAreAllQueriedAndTheFirstOneWins) {
    const Pose pose{{0.3, 0.2, 0.1}, {1.0, 0.0, 0.0, 0.0}};
    ContactTracker tracker(sceneOf(std::vector<SceneSurface>(1000, surfaceOf(Sphere{0.05}, pose))));
    EXPECT_EQ(tracker.update({0.0, {0.3, 0.25, 0.1}, {}, {}}).surfaceIndex, 0);
    EXPECT_EQ(tracker.statistics().surfaceQueries, 1000U);
}

TEST(BroadPhaseTest, APlaneIsTouchedAnyDistanceFromItsOriginAmongBoundedSurfaces) {
    Scene scene = gridOfSpheres(10);
    scene.surfaces.insert(scene.surfaces.begin() + 50, surfaceOf(Plane{}));
    ContactTracker tracker(scene);
    for (const double away : {0.225, -3.0, 1e3, -1e6, 1e9}) {
        const ContactReading reading = tracker.update({0.0, {away, 0.0, -away}, {}, {}});
        EXPECT_TRUE(reading.touching) << away;
        EXPECT_EQ(reading.surfaceIndex, 50) << away;
    }
}

TEST(BroadPhaseTest, AMovingSurfaceIsTouchedAtItsPresentPoseAndNotAtItsRestPose) {
    SceneSurface mover = surfaceOf(Sphere{0.05});
    mover.motion.emplace(std::vector<Keyframe>{{0.0, {{5.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}},
                                               {1.0, {{6.0, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}}}},
                         false);
    ContactTracker tracker(sceneOf({mover}));
    EXPECT_FALSE(tracker.update({0.5, {0.0, 0.05, 0.0}, {}, {}}).touching);
    EXPECT_TRUE(tracker.update({0.5, {5.5, 0.05, 0.0}, {}, {}}).touching);
    EXPECT_FALSE(tracker.update({1.0, {5.5, 0.05, 0.0}, {}, {}}).touching);
}

TEST(BroadPhaseTest, SurfacesOfTheLargestSizesAndDistancesAreFound) {
    const glm::dvec3 far(4e11, -4e11, 4e11);
    for (const double size : {1e-3, 1e6, 1e12}) {
        const SceneSurface box = surfaceOf(Box{glm::dvec3(size)}, {far, {1.0, 0.0, 0.0, 0.0}});
        ContactTracker tracker(sceneOf({surfaceOf(Sphere{0.1}), box}));
        EXPECT_EQ(tracker.update({0.0, far, {}, {}}).surfaceIndex, 1) << size;
    }
}

}  // namespace
}  // namespace haptoflow::headless
