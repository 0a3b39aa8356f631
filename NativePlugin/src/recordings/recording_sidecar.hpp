#pragma once

#include "recordings/recording_files.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace haptoflow::recordings {

/// Properties of a recording from the files beside it; empty if the recording's own columns give them.
struct RecordingSidecar {
    /// The path NAME.json, whether it exists or not.
    std::filesystem::path path;
    std::string label;
    std::optional<double> fullScaleMps2;
    /// A given speed is a velocity along the first axis.
    std::optional<std::array<double, 2>> velocityMps;
    std::optional<double> forceNewtons;
    /// 1 or -1: the sign with which a measured force counts pressing.
    std::optional<double> forceSign;
    /// What a measured force is where the tip touches nothing.
    std::optional<double> forceRestNewtons;
    /// A table of motion and force with its own time stamps.
    std::optional<std::filesystem::path> motion;
    std::optional<double> rateHz;
    std::string licence;
    std::string source;
};

/// Reads NAME.json beside NAME.csv or NAME.wav, and recordings.json in the same folder for keys that NAME.json does not
/// have. Throws RecordingUnusable that names file and key, the value found and the expected one.
[[nodiscard]] RecordingSidecar readRecordingSidecar(RecordingFiles& files, const std::filesystem::path& recording);

}  // namespace haptoflow::recordings
