#pragma once

#include "inference/segment_generator.hpp"

#include <span>
#include <vector>

namespace haptoflow::inference {

/// A velocity field u(x, t) for a point x in unit scale and a time t from 0 to 1. A batch is treated as one long point.
class VelocityField {
public:
    VelocityField() = default;
    VelocityField(const VelocityField&) = delete;
    VelocityField& operator=(const VelocityField&) = delete;
    virtual ~VelocityField() = default;

    /// Writes u(point, time) into `velocity`, which has the size of `point` and does not overlap it. `interval` is the
    /// length of the solver's step; only average-velocity fields read it.
    virtual void evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity) = 0;
};

inline constexpr int maximumSolverSteps = 16;

/// Throws std::invalid_argument unless `steps` is 1 to 16.
void checkSolverSettings(const SolverSettings& settings);

/// Explicit one-step solvers with equal steps. Used by one thread at a time; allocates if the point is larger than any
/// before.
class Solver {
public:
    /// Integrates `field` from time 0 to time 1, starting at `point`, and writes the result to `point`. Throws what the
    /// field throws, and std::invalid_argument for settings out of range.
    void integrate(VelocityField& field, const SolverSettings& settings, std::span<float> point);

private:
    std::vector<float> velocity_;
    std::vector<float> trialPoint_;
    std::vector<float> trialVelocity_;
};

}  // namespace haptoflow::inference
