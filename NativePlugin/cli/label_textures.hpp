#pragma once

#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace haptoflow::cli {

/// 200 ms of a label's waveform at 2 kHz. Its level does not count.
using TextureExcerpt = std::array<float, model::seedSamples>;

/// What the labels of a model sound like without its networks: their recorded seeds, or what its skeleton makes of the
/// usual speeds and forces.
class LabelTextures {
public:
    /// Keeps a reference to the model, which must live longer. Throws model::ModelError if its skeleton is incomplete.
    explicit LabelTextures(const model::ModelFile& model);

    /// Makes the excerpts of a label. Its noise is fixed, so a label has the same excerpts in every call.
    [[nodiscard]] std::vector<TextureExcerpt> of(std::size_t label) const;

private:
    const model::ModelFile& model_;
    skeleton::NativeParts native_;
};

}  // namespace haptoflow::cli
