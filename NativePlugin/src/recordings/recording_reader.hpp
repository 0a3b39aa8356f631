#pragma once

#include "recordings/recording.hpp"
#include "recordings/recording_files.hpp"
#include "recordings/recording_table.hpp"
#include "recordings/track.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::recordings {

/// Properties of a recording given by the caller, for what its files do not contain. `fullScaleMps2`, `forceSign` and
/// `forceRestNewtons` replace those of the sidecar.
struct RecordingWords {
    std::optional<double> speedMps{};
    std::optional<double> forceNewtons{};
    std::optional<double> fullScaleMps2{};
    /// 1 or -1: the sign with which the force's column counts pressing.
    std::optional<double> forceSign{};
    /// What the force's column reads where the tip touches nothing.
    std::optional<double> forceRestNewtons{};
};

/// What is read of the files beside a recording, and of its column names.
struct RecordingDescription {
    /// Empty texts are unknown.
    std::string label;
    std::string licence;
    std::string source;
    /// The path NAME.json, whether it exists or not.
    std::filesystem::path sidecar;
    std::optional<std::filesystem::path> motion;
    /// What was ignored or corrected, one sentence each.
    std::vector<std::string> notes;
};

/// The readings of each sensor at its own times, in SI units.
struct RecordingTracks {
    Track acceleration;
    /// Empty tracks where the file has none. A speed is a velocity along the first axis.
    Track motion;
    /// True if `motion` is positions in m, of which readings that repeat an older one are left out; false for
    /// velocities in m/s.
    bool hasPositions = false;
    Track force;
};

/// A recording of one material: as measured, and evenly sampled in the form that learning uses.
struct MaterialRecording {
    RecordingDescription description;
    RecordingTracks tracks;
    double rateHz = 0.0;
    std::size_t axisCount = 1;
    /// The first 300 s. Not finite where the recording has a gap.
    std::vector<float> accelerationMps2;
    /// Two numbers for each sample; empty if the velocity is constant or unknown.
    std::vector<float> velocityMps;
    std::optional<std::array<double, 2>> constantVelocityMps;
    /// Empty if the force is constant or unknown.
    std::vector<float> forceNewtons;
    std::optional<double> constantForceNewtons;

    [[nodiscard]] bool hasMotion() const { return !velocityMps.empty() || constantVelocityMps; }
    [[nodiscard]] bool hasForce() const { return !forceNewtons.empty() || constantForceNewtons; }

    /// For learning; unknown motion and force are zero.
    [[nodiscard]] Recording view() const;
};

/// Reads NAME.csv or NAME.wav with the files beside it: NAME.json, recordings.json, and the motion's table. Throws
/// RecordingUnusable that names the file, the line and column or the key, what was found and what is expected.
[[nodiscard]] MaterialRecording readMaterialRecording(RecordingFiles& files, const std::filesystem::path& path,
                                                      const RecordingWords& words);

/// Throws RecordingUnusable that names the columns and keys which can give them if motion or force is unknown.
/// `speedOption` and `forceOption` are named, too, if they are not empty.
void requireMotionAndForce(const RecordingDescription& description, const std::filesystem::path& path, bool hasMotion,
                           bool hasForce, const std::string& speedOption = "", const std::string& forceOption = "");

/// Reads what `readMaterialRecording` reads but for the rows.
[[nodiscard]] RecordingDescription describeRecording(RecordingFiles& files, const std::filesystem::path& path);

/// What a material learnt from one recording is called where nobody names it: the sidecar's label or else the file's
/// name, in lower case, with blanks for dashes, underscores and control characters.
[[nodiscard]] std::string materialName(const RecordingDescription& description, const std::filesystem::path& path);

/// What such a material's provenance says of the recording: the file's name and the sidecar's source.
[[nodiscard]] std::string provenanceOf(const RecordingDescription& description, const std::filesystem::path& path);

}  // namespace haptoflow::recordings
