#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>

namespace haptoflow::cli {

/// What the files beside a recording say of it; empty for what they leave to its columns.
struct RecordingSidecar {
    /// NAME.json, whether it exists or not.
    std::filesystem::path path;
    std::string label;
    std::optional<double> fullScaleMps2;
    /// A speed lies along the first axis.
    std::optional<std::array<double, 2>> velocityMps;
    std::optional<double> forceNewtons;
    /// A table of motion and force with a clock of its own.
    std::optional<std::filesystem::path> motion;
    std::optional<double> rateHz;
    std::string licence;
    std::string source;
};

/// Reads NAME.json beside NAME.csv or NAME.wav, and recordings.json in the same folder, whose keys hold where NAME.json
/// has none. Throws InputError that names file and key, what was found and what is expected.
[[nodiscard]] RecordingSidecar readRecordingSidecar(const std::filesystem::path& recording);

}  // namespace haptoflow::cli
