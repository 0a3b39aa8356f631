#pragma once

#include "inference/segment_generator.hpp"

#include <span>
#include <vector>

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

inline constexpr int maximumSolverSteps = 16;

/// Throws std::invalid_argument unless `steps` is 1 to 16.
void checkSolverSettings(const SolverSettings& settings);

/// Explicit one-step solvers with N equal steps. One user at a time; allocates when a larger point than before comes.
class Solver {
public:
    /// Carries `point` from time 0 to time 1 along `field`. Throws what the field throws, and std::invalid_argument
    /// for settings out of range.
    void integrate(VelocityField& field, const SolverSettings& settings, std::span<float> point);

private:
    std::vector<float> velocity_;
    std::vector<float> trialPoint_;
    std::vector<float> trialVelocity_;
};

}  // namespace haptoflow::inference
