#pragma once

#include "headless/motion.hpp"
#include "headless/pose.hpp"
#include "headless/shape.hpp"

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::headless {

/// An object of a scene that the tip can touch.
struct SceneSurface {
    std::string name;
    Shape shape;
    Pose pose;
    /// Replaces `pose` if set.
    std::optional<Motion> motion;
    /// Labels and weights; the weights sum to 1.
    std::vector<std::pair<std::string, double>> material;
    std::optional<double> stiffnessNewtonsPerMetre;
    /// Direction of the first tangent axis, in the object's local frame.
    glm::dvec3 grain{1.0, 0.0, 0.0};
    /// Size of the surface's features relative to the material's, and tilt of its spectrum in dB per octave.
    double spatialScale = 1.0;
    double toneDbPerOctave = 0.0;
    /// How much the object differs from others with the same labels, 0 to 1: which one it is, its seed says.
    double variation = 0.0;
    /// Names the surface: another number has another field of asperities and, with a variation, is another object.
    std::uint32_t seed = 0;

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept {
        return motion ? motion->poseAt(timeSeconds) : sanitised(pose);
    }
};

/// The surfaces that a stylus can touch, and the stylus's tip.
struct Scene {
    std::vector<SceneSurface> surfaces;
    double tipRadiusMetres = 0.001;
    /// Contact states per second that are computed along a stroke.
    double updateRateHz = 90.0;
};

}  // namespace haptoflow::headless
