#pragma once

#include "engine/contact_state.hpp"
#include "model/model_file.hpp"

#include <array>

namespace haptoflow::engine {

/// A blend of labels as the network and the range law take it: weighted means of what the labels say.
struct Material {
    std::array<float, model::embeddingSize> embedding{};
    double speedLevelExponent = 0.0;
    double forceLevelExponent = 0.0;
    double frequencyExponent = 0.0;
    /// The label with the largest weight: the one whose seeds start a touch.
    std::size_t dominantLabel = 0;
};

/// Unknown labels (an index beyond the model's) are left out; a blend without any weight is the model's first label.
[[nodiscard]] Material resolveMaterial(const model::ModelFile& model, const MaterialBlend& blend) noexcept;

}  // namespace haptoflow::engine
