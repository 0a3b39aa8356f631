#pragma once

#include <span>

namespace haptoflow::inference {

/// u(x, t): how fast a point of unit scale moves at a time from 0 to 1. A batch is one long point.
class VelocityField {
public:
    VelocityField() = default;
    VelocityField(const VelocityField&) = delete;
    VelocityField& operator=(const VelocityField&) = delete;
    virtual ~VelocityField() = default;

    /// Writes u(point, time) into `velocity`, which has the size of `point` and does not overlap it. `interval` is
    /// the length of the step that the value is wanted for; only average-velocity fields read it.
    virtual void evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity) = 0;
};

}  // namespace haptoflow::inference
