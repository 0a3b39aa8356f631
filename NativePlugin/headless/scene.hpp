#pragma once

#include "headless/motion.hpp"
#include "headless/pose.hpp"
#include "headless/shape.hpp"

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::headless {

/// An object that the tip can touch.
struct Surface {
    std::string name;
    Shape shape;
    Pose pose;
    /// Takes the place of `pose` where there is one.
    std::optional<Motion> motion;
    /// Labels and weights; the weights sum to 1.
    std::vector<std::pair<std::string, double>> material;
    std::optional<double> stiffnessNewtonsPerMetre;
    /// Direction of the first tangent axis, in the object's local frame.
    glm::dvec3 grain{1.0, 0.0, 0.0};
    /// How much larger its features are than the material's, and how much brighter or darker it is.
    double spatialScale = 1.0;
    double toneDbPerOctave = 0.0;

    [[nodiscard]] Pose poseAt(double timeSeconds) const noexcept {
        return motion ? motion->poseAt(timeSeconds) : sanitised(pose);
    }
};

/// What a stylus meets.
struct Scene {
    std::vector<Surface> surfaces;
    double tipRadiusMetres = 0.001;
    /// How often contact is computed along a stroke.
    double updateRateHz = 90.0;
};

}  // namespace haptoflow::headless
