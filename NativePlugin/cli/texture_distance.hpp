#pragma once

#include "effects/actuator_profile.hpp"
#include "effects/compensation.hpp"
#include "model/model_file.hpp"

#include <string>
#include <vector>

namespace haptoflow::cli {

/// Distance between the texture that an actuator plays and the original: log-spectral distance, the root mean square
/// over 20-1000 Hz of the difference of mean power spectra in dB.
struct TextureDistance {
    std::string label;
    double uncompensatedDecibels = 0.0;
    double compensatedDecibels = 0.0;
};

/// The distance for every label of a model: of its recorded seeds, and of what its skeleton makes of the usual speeds
/// and forces. One gain, the best for all labels together, is used with compensation and one without, like the setting
/// of an amplifier. Bins more than 30 dB below a label's maximum are ignored. The actuator is modelled by the magnitude
/// of its profile.
[[nodiscard]] std::vector<TextureDistance> textureDistances(const model::ModelFile& model,
                                                            const effects::ActuatorProfile& profile,
                                                            const effects::CompensationSettings& settings);

}  // namespace haptoflow::cli
