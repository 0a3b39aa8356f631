#pragma once

#include "learning/recording.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// Properties of a recording given on the command line; they replace those of the sidecar.
struct RecordingWords {
    std::optional<double> speedMps{};
    std::optional<double> forceNewtons{};
    std::optional<double> fullScaleMps2{};
};

/// A recording of one material, evenly sampled, in the form that learning uses.
struct MaterialRecording {
    double rateHz = 0.0;
    std::size_t axisCount = 1;
    std::vector<float> accelerationMps2;
    /// Two numbers for each sample; empty if the velocity is constant.
    std::vector<float> velocityMps;
    std::array<double, 2> constantVelocityMps{};
    /// Empty if the force is constant.
    std::vector<float> forceNewtons;
    double constantForceNewtons = 0.0;
    /// The label in the sidecar; empty if there is none.
    std::string label;
    std::string licence;
    std::string source;
    /// Ignored parts of the input, one line each.
    std::vector<std::string> notes;

    [[nodiscard]] learning::Recording view() const;
};

/// Reads NAME.csv or NAME.wav with the files beside it. Throws InputError that names the file, the column or key, the
/// value found and the expected one.
[[nodiscard]] MaterialRecording readMaterialRecording(const std::string& path, const RecordingWords& words);

}  // namespace haptoflow::cli
