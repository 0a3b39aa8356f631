#pragma once

#include "learning/recording.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {

/// What the command line says of a recording; it holds before what the sidecar says.
struct RecordingWords {
    std::optional<double> speedMps{};
    std::optional<double> forceNewtons{};
    std::optional<double> fullScaleMps2{};
};

/// A recording of one material, evenly sampled, as learning takes it.
struct MaterialRecording {
    double rateHz = 0.0;
    std::size_t axisCount = 1;
    std::vector<float> accelerationMps2;
    /// Two numbers for each sample; empty where the velocity is constant.
    std::vector<float> velocityMps;
    std::array<double, 2> constantVelocityMps{};
    /// Empty where the force is constant.
    std::vector<float> forceNewtons;
    double constantForceNewtons = 0.0;
    /// What the sidecar calls it; empty where nobody said.
    std::string label;
    std::string licence;
    std::string source;
    /// What was ignored, a line each.
    std::vector<std::string> notes;

    [[nodiscard]] learning::Recording view() const;
};

/// Reads NAME.csv or NAME.wav with what stands beside it. Throws InputError that names file, column or key, what was
/// found, and what is expected.
[[nodiscard]] MaterialRecording readMaterialRecording(const std::string& path, const RecordingWords& words);

}  // namespace haptoflow::cli
