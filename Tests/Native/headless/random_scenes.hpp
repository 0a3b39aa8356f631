#pragma once

#include "test_scenes.hpp"

#include <cmath>
#include <cstdint>
#include <random>

namespace haptoflow::headless::testing {

/// Scenes with every kind of surface, at rest and moving, in a cube whose size keeps their density constant, and
/// strokes from one surface to the next.
class RandomScenes {
public:
    RandomScenes(std::uint32_t seed, std::size_t surfaces, const glm::dvec3& originMetres)
        : random_(seed),
          count_(surfaces),
          sideMetres_(0.1 * std::cbrt(static_cast<double>(surfaces))),
          origin_(originMetres) {}

    /// Every tenth surface moves, some of them far; every fifth is in the same place as the previous one; two are
    /// planes.
    Scene scene() {
        std::vector<SceneSurface> surfaces;
        for (std::size_t index = 0; index < count_; ++index) {
            if (index % 10 == 6 || index % 10 == 8) {
                surfaces.push_back(surfaces.back());
                continue;
            }
            surfaces.push_back(surfaceOf(anyShape(index), anyPose()));
            surfaces.back().grain = anyVector();
            if (index % 10 == 5) {
                const Pose home = surfaces.back().pose;
                const Pose away = index % 20 == 5 ? near(home) : anyPose();
                surfaces.back().motion.emplace(
                    std::vector<Keyframe>{{0.0, home}, {1.0, away}, {2.5, near(away)}, {3.0, home}}, true);
            }
        }
        surfaces[2] =
            surfaceOf(Plane{}, {origin_ - glm::dvec3(0.0, 0.5 * sideMetres_, 0.0), turned(4.0, {1.0, 0.0, 2.0})});
        surfaces[count_ - 1] =
            surfaceOf(Plane{}, {origin_ + glm::dvec3(0.5 * sideMetres_, 0.0, 0.0), turned(85.0, {0.0, 0.0, 1.0})});
        return sceneOf(std::move(surfaces), 0.004);
    }

    /// A stroke at 90 Hz. Every third leg begins with a jump.
    std::vector<TipSample> strokeOver(const Scene& scene, std::size_t frames) {
        std::vector<TipSample> samples;
        glm::dvec3 tip = origin_;
        while (samples.size() < frames) {
            const SceneSurface& aim = scene.surfaces[random_() % scene.surfaces.size()];
            const double now = static_cast<double>(samples.size()) / 90.0;
            const glm::dvec3 target = aim.poseAt(now).positionMetres + 0.02 * anyVector();
            const glm::dvec3 from = random_() % 3 == 0 ? target + 0.03 * anyVector() : tip;
            const int steps = 2 + static_cast<int>(glm::distance(target, from) / 0.02);
            for (int step = 1; step <= steps; ++step) {
                tip = from + (target - from) * (static_cast<double>(step) / steps);
                samples.push_back({static_cast<double>(samples.size()) / 90.0, tip, std::nullopt, std::nullopt});
            }
        }
        return samples;
    }

private:
    double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
    glm::dvec3 anyVector() {
        const double x = between(-1.0, 1.0);
        const double y = between(-1.0, 1.0);
        return {x, y, between(-1.0, 1.0)};
    }
    Pose anyPose() {
        const glm::dvec3 place = origin_ + 0.5 * sideMetres_ * anyVector();
        return {place, turned(between(0.0, 180.0), anyVector())};
    }
    Pose near(const Pose& pose) {
        const glm::dvec3 place = pose.positionMetres + 0.03 * anyVector();
        return {place, turned(between(0.0, 60.0), anyVector()) * pose.rotation};
    }
    Shape anyShape(std::size_t index) {
        const double size = (index % 25 == 9 ? 10.0 : 1.0) * between(0.01, 0.04);
        switch (random_() % 5) {
            case 0:
                return Sphere{size};
            case 1:
                return Capsule{0.5 * size, 3.0 * size};
            case 2:
                return ring_;
            case 3:
                return sheet_;
            default:
                return Box{size * (glm::dvec3(1.5) + anyVector())};
        }
    }

    std::mt19937 random_;
    std::size_t count_;
    double sideMetres_;
    glm::dvec3 origin_;
    Shape ring_ = meshOf(rawTorus(0.03, 0.01, 16, 8));
    /// An open mesh far from its own origin.
    Shape sheet_ = std::make_shared<const TriangleMesh>(
        std::vector<glm::dvec3>{{0.02, 0.05, 0.02}, {0.02, 0.05, 0.08}, {0.08, 0.05, 0.08}, {0.08, 0.06, 0.02}},
        std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {0, 2, 3}});
};

}  // namespace haptoflow::headless::testing
