#pragma once

#include "recordings/recording_reader.hpp"

#include <filesystem>
#include <string>

namespace haptoflow::recordings {

/// What a material learnt from one recording is called where nobody names it: the sidecar's label or else the file's
/// name, in lower case, with blanks for dashes, underscores and control characters.
[[nodiscard]] std::string materialName(const RecordingDescription& description, const std::filesystem::path& path);

/// What such a material's provenance says of the recording: the file's name and the sidecar's source.
[[nodiscard]] std::string provenanceOf(const RecordingDescription& description, const std::filesystem::path& path);

}  // namespace haptoflow::recordings
