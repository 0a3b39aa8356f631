#pragma once

#include "engine/material_library.hpp"
#include "fake_generators.hpp"
#include "test_model.hpp"

#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace haptoflow::engine::testing {

struct LabelWeight {
    std::uint32_t label = 0;
    float weight = 0.0F;
};

inline MaterialBlend blendOf(const std::vector<LabelWeight>& entries) {
    MaterialBlend blend;
    for (const LabelWeight entry : entries) {
        blend.add(entry.label, entry.weight);
    }
    return blend;
}

/// A model and its material library, with the levels of a generator.
struct SmallLibrary {
    explicit SmallLibrary(model::ModelFile file = smallModel()) : model(std::move(file)) {}

    /// The materials of a blend; valid until a material is replaced.
    [[nodiscard]] Ingredients ingredients(const MaterialBlend& blend) const {
        return MaterialLibrary::ReadScope(library).ingredients(blend);
    }
    [[nodiscard]] Ingredients ingredients(std::initializer_list<LabelWeight> entries) const {
        return ingredients(blendOf(entries));
    }
    [[nodiscard]] MaterialLibrary::LevelSource levels() {
        return [this]() -> inference::LevelEstimator& { return generator; };
    }

    model::ModelFile model;
    MotionGenerator generator;
    MaterialLibrary library{model, generator};
};

}  // namespace haptoflow::engine::testing
