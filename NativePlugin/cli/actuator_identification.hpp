#pragma once

#include "effects/actuator_profile.hpp"
#include "exponential_sweep.hpp"
#include "output_file.hpp"

#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

struct IdentificationSettings {
    std::string name;
    /// Name of the recording in errors and in the profile's provenance.
    std::string recordingName;
    /// m/s^2 of a sample of 1 in the recording; empty if the sensor is not calibrated.
    std::optional<double> mps2PerUnit;
};

/// The actuator's properties that follow from a recorded sweep.
struct Identification {
    effects::ActuatorProfile profile;
    /// The measurement's noise at the profile's frequencies, in dB on the scale of the profile's magnitude.
    std::vector<double> noiseDecibels;
    /// The second to fifth harmonic of a tone of that frequency together, on the same scale; NaN if they lie above the
    /// sweep's range.
    std::vector<double> distortionDecibels;
};

/// Finds the delay, deconvolves, separates the harmonics and smooths over a twelfth of an octave. The recording's rate
/// may differ from that of the played file. Throws InputError that names the recording: too short, clipped, silent,
/// without the sweep, or too noisy.
[[nodiscard]] Identification identifyActuator(const Recording& recording, const ExponentialSweep& sweep,
                                              const IdentificationSettings& settings);

}  // namespace haptoflow::cli
