#pragma once

#include "engine/material_library.hpp"
#include "fake_generators.hpp"
#include "test_model.hpp"

#include <initializer_list>
#include <utility>

namespace haptoflow::engine::testing {

inline MaterialBlend blendOf(std::initializer_list<LabelWeight> entries) {
    MaterialBlend blend;
    for (const LabelWeight entry : entries) {
        blend.entries.at(blend.count++) = entry;
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
