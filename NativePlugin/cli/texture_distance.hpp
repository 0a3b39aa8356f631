#pragma once

#include "effects/actuator_profile.hpp"
#include "effects/compensation.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <array>
#include <cstddef>
#include <string>
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

/// Distance between the texture that an actuator plays and the original: log-spectral distance, the root mean square
/// over 20-1000 Hz of the difference of mean power spectra in dB.
struct TextureDistance {
    std::string label;
    double uncompensatedDecibels = 0.0;
    double compensatedDecibels = 0.0;
};

/// The distance for every label of a model, over its LabelTextures. One gain, the best for all labels together, is
/// used with compensation and one without, like the setting of an amplifier. Bins more than 30 dB below a label's
/// maximum are ignored. The actuator is modelled by the magnitude of its profile.
[[nodiscard]] std::vector<TextureDistance> textureDistances(const model::ModelFile& model,
                                                            const effects::ActuatorProfile& profile,
                                                            const effects::CompensationSettings& settings);

}  // namespace haptoflow::cli
