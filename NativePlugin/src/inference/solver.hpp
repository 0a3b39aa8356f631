#pragma once

#include "inference/segment_generator.hpp"
#include "inference/velocity_field.hpp"

#include <span>
#include <vector>

namespace haptoflow::inference {

inline constexpr int maximumSolverSteps = 16;

/// Throws std::invalid_argument unless `steps` is 1 to 16.
void checkSolverSettings(const SolverSettings& settings);

/// How often a solver evaluates its field to carry a point from time 0 to 1.
[[nodiscard]] int fieldEvaluations(const SolverSettings& settings) noexcept;

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
