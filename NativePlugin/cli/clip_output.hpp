#pragma once

#include "clips/clip_formats.hpp"
#include "effects/carrier_rendering.hpp"
#include "output_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// The format of a file's name by its ending; nothing for other files.
[[nodiscard]] std::optional<clips::ClipFormat> clipFormatOf(std::string_view path);

/// The date of today in UTC: YYYY-MM-DD.
[[nodiscard]] std::string today();

/// What became of a clip in a file.
struct ClipFigures {
    std::string file;
    std::size_t amplitudePoints = 0;
    std::size_t frequencyPoints = 0;
    std::size_t transients = 0;
    double amplitudeErrorDb = 0.0;
    double frequencyErrorPercent = 0.0;
    /// What a device with amplitude and frequency plays of the file, against the wave that it was made from.
    effects::IntensityErrors intensity{};
};

/// Writes a clip to a file's partial, in the format of its name. `waveMps2` is the 2 kHz wave of which it was made.
/// Throws InputError that names the file.
[[nodiscard]] ClipFigures writeClipFile(const OutputFile& file, const clips::HapticClip& clip,
                                        std::span<const float> waveMps2);

/// Prints a note if a clip's points do not follow its amplitude within half a decibel.
void noteCoarseClip(const ClipFigures& figures);

/// Prints what a clip file has and what a motor plays of it; as JSON if `asJson`. Draws it to `picturePath`, an SVG,
/// unless that is empty. Throws InputError that names the file.
void inspectClip(const std::string& path, bool asJson, const std::string& picturePath);

}  // namespace haptoflow::cli
