#include "headless/shape.hpp"

#include "headless/contact_tracker.hpp"
#include "headless/scene.hpp"
#include "headless/triangle_mesh.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <stdexcept>

namespace haptoflow::headless {
namespace {

using testing::RawMesh;

SurfacePoint query(const Shape& shape, const glm::dvec3& point, std::optional<glm::dvec3> previousNormal = {}) {
    QueryOptions options;
    options.previousNormal = previousNormal;
    const std::optional<SurfacePoint> found = closestSurfacePoint(shape, point, options);
    EXPECT_TRUE(found.has_value());
    return found.value_or(SurfacePoint{});
}

void expectNear(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-12) {
    EXPECT_NEAR(actual.x, expected.x, tolerance);
    EXPECT_NEAR(actual.y, expected.y, tolerance);
    EXPECT_NEAR(actual.z, expected.z, tolerance);
}

TEST(ShapeTest, TheNearestPointOfABoxIsOnAFaceAnEdgeOrACorner) {
    const Box box{{2.0, 4.0, 6.0}};
    const SurfacePoint face = query(box, {1.5, 0.5, 0.5});
    expectNear(face.pointMetres, {1.0, 0.5, 0.5});
    expectNear(face.normal, {1.0, 0.0, 0.0});
    EXPECT_DOUBLE_EQ(face.signedDistanceMetres, 0.5);
    const SurfacePoint edge = query(box, {1.3, 2.4, 0.0});
    expectNear(edge.pointMetres, {1.0, 2.0, 0.0});
    expectNear(edge.normal, {0.6, 0.8, 0.0});
    EXPECT_NEAR(edge.signedDistanceMetres, 0.5, 1e-12);
    const SurfacePoint corner = query(box, {2.0, 4.0, 5.0});
    expectNear(corner.pointMetres, {1.0, 2.0, 3.0});
    expectNear(corner.normal, {1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0});
    EXPECT_NEAR(corner.signedDistanceMetres, 3.0, 1e-12);
}

TEST(ShapeTest, TheFaceOfThePreviousFrameIsKeptUntilAnotherIsNearerByTheMargin) {
    const Box box{{0.1, 0.1, 0.1}};
    const glm::dvec3 up(0.0, 1.0, 0.0);
    // 10.0 mm below the top, 9.7 mm from the side, then 9.4 mm.
    expectNear(query(box, {0.0403, 0.0400, 0.0}, up).normal, up);
    expectNear(query(box, {0.0403, 0.0400, 0.0}).normal, {1.0, 0.0, 0.0});
    expectNear(query(box, {0.0406, 0.0400, 0.0}, up).normal, {1.0, 0.0, 0.0});
}

TEST(ShapeTest, TheNearestPointOfASphereIsOnTheRadiusAndItsCentreKeepsThePreviousNormal) {
    const SurfacePoint outside = query(Sphere{2.0}, {0.0, 0.0, -3.0});
    expectNear(outside.pointMetres, {0.0, 0.0, -2.0});
    EXPECT_NEAR(outside.signedDistanceMetres, 1.0, 1e-12);
    const SurfacePoint inside = query(Sphere{2.0}, {0.5, 0.0, 0.0});
    expectNear(inside.normal, {1.0, 0.0, 0.0});
    EXPECT_NEAR(inside.signedDistanceMetres, -1.5, 1e-12);
    const glm::dvec3 previous = glm::normalize(glm::dvec3(1.0, 2.0, 3.0));
    expectNear(query(Sphere{2.0}, glm::dvec3(0.0), previous).normal, previous);
    expectNear(query(Sphere{2.0}, glm::dvec3(0.0)).normal, {0.0, 1.0, 0.0});
}

TEST(ShapeTest, ACapsuleIsACylinderWithRoundCapsWithinTheTotalHeight) {
    const Capsule capsule{0.5, 3.0};
    expectNear(query(capsule, {0.0, 2.0, 0.0}).pointMetres, {0.0, 1.5, 0.0});
    const SurfacePoint wall = query(capsule, {0.0, 0.7, 2.0});
    expectNear(wall.pointMetres, {0.0, 0.7, 0.5});
    EXPECT_NEAR(wall.signedDistanceMetres, 1.5, 1e-12);
    const SurfacePoint axis = query(capsule, {0.0, 0.7, 0.0}, glm::dvec3(0.0, 0.8, 0.6));
    expectNear(axis.normal, {0.0, 0.0, 1.0});
    EXPECT_DOUBLE_EQ(axis.signedDistanceMetres, -0.5);
}

TEST(ShapeTest, TheNormalHasUnitLengthAndPointsFromTheContactToTheTipAtEveryScale) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> spread(-2.0, 2.0);
    for (const double scale : {1e-6, 1e-3, 1.0, 1e6}) {
        const std::vector<Shape> shapes{Box{glm::dvec3(1.0, 2.0, 0.5) * scale}, Sphere{scale},
                                        Capsule{0.4 * scale, 2.0 * scale}, Plane{},
                                        testing::meshOf(testing::rawTorus(scale, 0.4 * scale, 24, 12))};
        for (const Shape& shape : shapes) {
            for (int trial = 0; trial < 300; ++trial) {
                const glm::dvec3 point = scale * glm::dvec3(spread(random), spread(random), spread(random));
                const SurfacePoint found = query(shape, point);
                EXPECT_NEAR(glm::length(found.normal), 1.0, 1e-12);
                expectNear(found.pointMetres + found.normal * found.signedDistanceMetres, point, 1e-9 * scale);
            }
        }
    }
}

TEST(ShapeTest, TheBoundingSphereContainsTheWholeShape) {
    std::mt19937 random(11);
    std::normal_distribution<double> normal;
    for (const Shape& shape : {Shape(Box{{1.0, 2.0, 0.5}}), Shape(Sphere{0.7}), Shape(Capsule{0.4, 2.0}),
                               Shape(testing::meshOf(testing::rawTorus(1.0, 0.4, 24, 12)))}) {
        const BoundingSphere bounds = boundingSphere(shape);
        for (int trial = 0; trial < 300; ++trial) {
            const glm::dvec3 far(4.0 * normal(random), 4.0 * normal(random), 4.0 * normal(random));
            const glm::dvec3 onSurface = query(shape, far).pointMetres;
            EXPECT_LE(glm::distance(onSurface, bounds.centreMetres), bounds.radiusMetres * (1.0 + 1e-12));
        }
    }
}

TEST(TriangleMeshTest, TheTreeFindsExactlyTheResultOfASearchThroughAllTriangles) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> spread(-2.0, 2.0);
    RawMesh soup;
    for (std::uint32_t triangle = 0; triangle < 400; ++triangle) {
        const glm::dvec3 centre(spread(random), spread(random), spread(random));
        for (int corner = 0; corner < 3; ++corner) {
            soup.vertices.push_back(centre + 0.2 * glm::dvec3(spread(random), spread(random), spread(random)));
        }
        soup.triangles.push_back({3 * triangle, 3 * triangle + 1, 3 * triangle + 2});
    }
    for (const RawMesh& raw : {soup, testing::rawTorus(1.0, 0.4, 12, 8), testing::rawBoxMesh({0.5, 0.7, 0.9})}) {
        const TriangleMesh mesh(raw.vertices, raw.triangles);
        std::vector<TriangleMesh> single;
        for (const TriangleMesh::Triangle& triangle : raw.triangles) {
            single.emplace_back(raw.vertices, std::vector<TriangleMesh::Triangle>{triangle});
        }
        for (int trial = 0; trial < 300; ++trial) {
            const glm::dvec3 point(spread(random), spread(random), spread(random));
            double nearest = testing::infinity;
            for (const TriangleMesh& one : single) {
                nearest = std::min(nearest, one.closestPoint(point).distanceMetres);
            }
            EXPECT_EQ(mesh.closestPoint(point).distanceMetres, nearest);
        }
    }
}

TEST(TriangleMeshTest, InsideAndOutsideOfATorusAgreeWithItsFormula) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> spread(-1.6, 1.6);
    const RawMesh raw = testing::rawTorus(1.0, 0.4, 96, 48);
    const TriangleMesh mesh(raw.vertices, raw.triangles);
    EXPECT_TRUE(mesh.isClosed());
    for (int trial = 0; trial < 2000; ++trial) {
        const glm::dvec3 point(spread(random), 0.5 * spread(random), spread(random));
        const double distance = std::hypot(std::hypot(point.x, point.z) - 1.0, point.y) - 0.4;
        if (std::abs(distance) > 0.005) {
            EXPECT_EQ(mesh.closestPoint(point).behind, distance < 0.0);
        }
    }
}

TEST(TriangleMeshTest, AMeshThatIsInsideOutIsTurned) {
    RawMesh raw = testing::rawBoxMesh({0.5, 0.5, 0.5});
    for (auto& triangle : raw.triangles) {
        std::swap(triangle[1], triangle[2]);
    }
    const TriangleMesh mesh(raw.vertices, raw.triangles);
    EXPECT_TRUE(mesh.isClosed());
    EXPECT_TRUE(mesh.closestPoint({0.4, 0.0, 0.0}).behind);
    EXPECT_FALSE(mesh.closestPoint({0.6, 0.0, 0.0}).behind);
    EXPECT_GT(mesh.closestPoint({0.6, 0.0, 0.0}).normal.x, 0.99);
}

TEST(TriangleMeshTest, AnOpenMeshIsTouchedFromItsFrontToALimitedDepthWithinItsRim) {
    const auto sheet = std::make_shared<const TriangleMesh>(
        std::vector<glm::dvec3>{{-1.0, 0.0, -1.0}, {-1.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 0.0, -1.0}},
        std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}});
    EXPECT_FALSE(sheet->isClosed());
    const Shape shape = sheet;
    const auto front = closestSurfacePoint(shape, {0.2, 0.001, 0.1}, {});
    ASSERT_TRUE(front);
    EXPECT_NEAR(front->signedDistanceMetres, 0.001, 1e-15);
    EXPECT_DOUBLE_EQ(front->normal.y, 1.0);
    const auto shallow = closestSurfacePoint(shape, {0.2, -0.004, 0.1}, {});
    ASSERT_TRUE(shallow);
    EXPECT_NEAR(shallow->signedDistanceMetres, -0.004, 1e-15);
    EXPECT_DOUBLE_EQ(shallow->normal.y, 1.0);
    EXPECT_FALSE(closestSurfacePoint(shape, {0.2, -0.006, 0.1}, {}));
    EXPECT_FALSE(closestSurfacePoint(shape, {1.001, -0.001, 0.1}, {}));
    EXPECT_TRUE(closestSurfacePoint(shape, {1.001, 0.001, 0.1}, {}));
}

TEST(TriangleMeshTest, TrianglesWithoutAreaChangeNothing) {
    RawMesh raw = testing::rawBoxMesh({0.5, 0.5, 0.5});
    raw.triangles.push_back({0, 0, 1});
    raw.triangles.push_back({2, 2, 2});
    const TriangleMesh mesh(raw.vertices, raw.triangles);
    EXPECT_TRUE(mesh.isClosed());
    EXPECT_NEAR(mesh.closestPoint({0.7, 0.1, 0.1}).distanceMetres, 0.2, 1e-12);
}

TEST(TriangleMeshTest, AMeshWithoutAreaIsRefused) {
    const std::vector<glm::dvec3> corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    EXPECT_THROW(TriangleMesh(corners, {}), std::invalid_argument);
    EXPECT_THROW(TriangleMesh(corners, {{0, 1, 1}}), std::invalid_argument);
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
