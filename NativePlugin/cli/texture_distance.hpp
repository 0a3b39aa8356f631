#pragma once

#include "effects/actuator_profile.hpp"
#include "effects/compensation.hpp"
#include "model/model_file.hpp"

#include <string>
#include <vector>

namespace haptoflow::cli {

/// How far what an actuator plays is from the texture that was wanted: log-spectral distance, the root mean square over
/// 20-1000 Hz of the difference of mean power spectra in dB.
struct TextureDistance {
    std::string label;
    double uncompensatedDecibels = 0.0;
    double compensatedDecibels = 0.0;
};

/// For every label of a model, by its recorded seeds. One strength, the best for all labels together, is set with and
/// one without compensation, as by an amplifier's knob. Bins more than 30 dB below a label's loudest are left out. The
/// actuator is its profile's magnitude.
[[nodiscard]] std::vector<TextureDistance> textureDistances(const model::ModelFile& model,
                                                            const effects::ActuatorProfile& profile,
                                                            const effects::CompensationSettings& settings);

}  // namespace haptoflow::cli
