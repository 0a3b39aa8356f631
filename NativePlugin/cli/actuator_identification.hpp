#pragma once

#include "effects/actuator_profile.hpp"
#include "exponential_sweep.hpp"
#include "wav_file.hpp"

#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

struct IdentificationSettings {
    std::string name;
    /// Of the recording, as errors and the provenance call it.
    std::string recordingName;
    /// m/s^2 of a sample of 1 in the recording; none where the sensor is not calibrated.
    std::optional<double> mps2PerUnit;
};

/// What a recorded sweep says about the actuator that played it.
struct Identification {
    effects::ActuatorProfile profile;
    /// At the profile's frequencies, dB as the profile's magnitude: what noise the measurement would have shown.
    std::vector<double> noiseDecibels;
    /// The same of the second to fifth harmonic of a tone of that frequency, together; NaN where they lie above the
    /// sweep's range.
    std::vector<double> distortionDecibels;
};

/// Finds the delay, deconvolves, separates the harmonics, smooths over a twelfth of an octave. The recording may have
/// another rate than the file that was played. Throws InputError naming the recording: too short, clipped, silent,
/// without the sweep, too noisy.
[[nodiscard]] Identification identifyActuator(const Recording& recording, const ExponentialSweep& sweep,
                                              const IdentificationSettings& settings);

}  // namespace haptoflow::cli
