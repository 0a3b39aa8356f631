#pragma once

#include "model/model_header.hpp"
#include "skeleton/linear_layer.hpp"
#include "skeleton/motion_features.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton_layout.hpp"

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

}  // namespace haptoflow::skeleton
