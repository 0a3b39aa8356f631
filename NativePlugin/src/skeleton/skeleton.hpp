#pragma once

#include "model/model_header.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/excitation.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/reflection_filter.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::skeleton {

/// A material's level: a power law of speed and force whose three numbers are linear in the embedding, and a correction
/// of at most +-0.9 by a perceptron, which also sees how fast the tip crosses the material's ribs.
class LevelModel {
public:
    static constexpr std::size_t correctionInputs = model::embeddingSize + smoothFeatures + ribCount;

    /// `law`: 64 inputs, 3 outputs. `correction`: 64 + 12 + 2 inputs, 1 output.
    LevelModel(LinearLayer law, Perceptron correction);

    /// The natural logarithm of the RMS in m/s^2; not finite if an argument is not. Any thread; no allocation.
    [[nodiscard]] float logLevel(std::span<const float, model::embeddingSize> embedding,
                                 const Motion& motion) const noexcept;

private:
    LinearLayer law_;
    Perceptron correction_;
};

/// The last layer of the perceptron `skeleton`, cut by what its outputs are for, so that a family that is not heard
/// costs nothing.
struct OutputLayers {
    /// Reflections and gain.
    LinearLayer filter;
    /// Of each family the swing's cosines and sines, then the lines' cosines and sines.
    std::array<LinearLayer, familyCount> families;
    LinearLayer impulseGains;
};

/// What a contact sounds like: outputs of the perceptron. A plain value.
struct SkeletonParameters {
    ReflectionFilter filter;
    /// Zero for a family that is not heard.
    std::array<FamilyGains, familyCount> families{};
    std::array<float, TailImpulses::gainCount> impulseGains{};
};

/// Natural logarithm of the mean square, in unit scale, of what these parameters sound like at the families' rates: of
/// noise and lines behind the filter. Swing and impulses, which add a tenth of a decibel, are left out.
[[nodiscard]] double logPowerOf(const SkeletonParameters& parameters,
                                const std::array<double, familyCount>& ratesHz) noexcept;

/// What sounds without a graph: a filter, driven by noise, by the lines of ribs and stick-slip, and by impulses (see
/// Synthesis). Immutable, so that any number of threads may use it; allocates nothing while it runs.
class Skeleton {
public:
    Skeleton(HiddenLayers hidden, OutputLayers outputs);

    /// `ratesHz`: signed rates of the families of waves. `impulseGain`: factor on the impulses.
    [[nodiscard]] SkeletonParameters parametersFor(const Condition& condition,
                                                   const std::array<double, familyCount>& ratesHz,
                                                   float impulseGain = 1.0F) const noexcept;
    /// The filter alone, which costs a fraction of the whole.
    [[nodiscard]] ReflectionFilter filterFor(const Condition& condition) const noexcept;
    [[nodiscard]] const TailImpulses& impulses() const noexcept { return impulses_; }

private:
    [[nodiscard]] ReflectionFilter filterOf(const HiddenLayers::Activations& activations) const noexcept;

    HiddenLayers hidden_;
    OutputLayers outputs_;
    TailImpulses impulses_;
};

}  // namespace haptoflow::skeleton
