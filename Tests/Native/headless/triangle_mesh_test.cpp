#include "headless/triangle_mesh.hpp"

#include "headless/shape.hpp"
#include "test_scenes.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <stdexcept>

namespace haptoflow::headless {
namespace {

using testing::nan;
using testing::RawMesh;

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
    for (const RawMesh& raw : {soup, testing::rawTorus(1.0, 0.4, 48, 24), testing::rawBoxMesh({0.5, 0.7, 0.9})}) {
        const TriangleMesh mesh(raw.vertices, raw.triangles);
        for (int trial = 0; trial < 1000; ++trial) {
            const glm::dvec3 point(spread(random), spread(random), spread(random));
            const MeshPoint fast = mesh.closestPoint(point);
            const MeshPoint slow = mesh.closestPointOfAll(point);
            EXPECT_EQ(fast.pointMetres, slow.pointMetres);
            EXPECT_EQ(fast.normal, slow.normal);
            EXPECT_EQ(fast.distanceMetres, slow.distanceMetres);
            EXPECT_EQ(fast.behind, slow.behind);
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

TEST(TriangleMeshTest, ABoxMeshAgreesWithTheBoxShape) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> spread(-1.0, 1.0);
    const Shape mesh = testing::meshOf(testing::rawBoxMesh({0.3, 0.4, 0.5}));
    const Shape box = Box{{0.6, 0.8, 1.0}};
    for (int trial = 0; trial < 2000; ++trial) {
        const glm::dvec3 point(spread(random), spread(random), spread(random));
        const auto a = closestSurfacePoint(mesh, point, {});
        const auto b = closestSurfacePoint(box, point, {});
        ASSERT_TRUE(a && b);
        EXPECT_NEAR(a->signedDistanceMetres, b->signedDistanceMetres, 1e-12);
        EXPECT_LT(testing::degreesBetween(a->normal, b->normal), 1e-6);
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

TEST(TriangleMeshTest, ATipDeepInAMeshKeepsItsFaceWithinTheMargin) {
    const Shape mesh = testing::meshOf(testing::rawBoxMesh({0.05, 0.05, 0.05}));
    QueryOptions options;
    options.previousNormal = glm::dvec3(0.0, 1.0, 0.0);
    const auto kept = closestSurfacePoint(mesh, {0.0403, 0.0400, 0.001}, options);
    ASSERT_TRUE(kept);
    EXPECT_GT(kept->normal.y, 0.99);
    EXPECT_NEAR(kept->signedDistanceMetres, -0.0100, 1e-12);
    const auto left = closestSurfacePoint(mesh, {0.0406, 0.0400, 0.001}, options);
    ASSERT_TRUE(left);
    EXPECT_GT(left->normal.x, 0.99);
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

TEST(TriangleMeshTest, InvalidInputIsRefused) {
    const std::vector<glm::dvec3> corners{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    EXPECT_THROW(TriangleMesh(corners, {{0, 1, 3}}), std::invalid_argument);
    EXPECT_THROW(TriangleMesh(corners, {}), std::invalid_argument);
    EXPECT_THROW(TriangleMesh(corners, {{0, 1, 1}}), std::invalid_argument);
    EXPECT_THROW(TriangleMesh({{nan, 0.0, 0.0}, corners[1], corners[2]}, {{0, 1, 2}}), std::invalid_argument);
}

TEST(TriangleMeshTest, MeshesFromAMicrometreToAThousandKilometresWork) {
    for (const double scale : {1e-6, 1e6}) {
        const RawMesh raw = testing::rawBoxMesh(glm::dvec3(0.5) * scale);
        const TriangleMesh mesh(raw.vertices, raw.triangles);
        EXPECT_TRUE(mesh.isClosed());
        const MeshPoint found = mesh.closestPoint({0.0, 0.4 * scale, 0.1 * scale});
        EXPECT_TRUE(found.behind);
        EXPECT_NEAR(found.distanceMetres, 0.1 * scale, 1e-12 * scale);
        EXPECT_NEAR(found.normal.y, 1.0, 1e-12);
    }
}

}  // namespace
}  // namespace haptoflow::headless
