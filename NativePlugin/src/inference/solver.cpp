#include "inference/solver.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>

namespace haptoflow::inference {
namespace {

/// result = point + factor * direction, element by element.
void advance(std::span<const float> point, float factor, std::span<const float> direction, std::span<float> result) {
    for (std::size_t index = 0; index < result.size(); ++index) {
        result[index] = point[index] + factor * direction[index];
    }
}

}  // namespace

void checkSolverSettings(const SolverSettings& settings) {
    if (settings.steps < 1 || settings.steps > maximumSolverSteps) {
        throw std::invalid_argument("the solver has " + std::to_string(settings.steps) + " steps; expected 1 to 16");
    }
}

void Solver::integrate(VelocityField& field, const SolverSettings& settings, std::span<float> point) {
    checkSolverSettings(settings);
    velocity_.resize(point.size());
    trialPoint_.resize(point.size());
    trialVelocity_.resize(point.size());

    const double stepCount = settings.steps;
    const auto step = static_cast<float>(1.0 / stepCount);
    for (int index = 0; index < settings.steps; ++index) {
        const auto start = static_cast<float>(index / stepCount);
        const auto middle = static_cast<float>((index + 0.5) / stepCount);
        const auto end = static_cast<float>((index + 1) / stepCount);
        field.evaluate(point, start, step, velocity_);
        switch (settings.kind) {
            case SolverKind::euler:
                advance(point, step, velocity_, point);
                break;
            case SolverKind::midpoint:
                advance(point, 0.5F * step, velocity_, trialPoint_);
                field.evaluate(trialPoint_, middle, step, trialVelocity_);
                advance(point, step, trialVelocity_, point);
                break;
            case SolverKind::heun:
                advance(point, step, velocity_, trialPoint_);
                field.evaluate(trialPoint_, end, step, trialVelocity_);
                advance(point, 0.5F * step, velocity_, point);
                advance(point, 0.5F * step, trialVelocity_, point);
                break;
        }
    }
}

}  // namespace haptoflow::inference
