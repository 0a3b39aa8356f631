#pragma once

#include "clips/clip_formats.hpp"
#include "effects/carrier_rendering.hpp"
#include "output_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// The format of a file's name by its ending; nothing for other files.
[[nodiscard]] std::optional<clips::ClipFormat> clipFormatOf(std::string_view path);

/// How a clip was rendered, for its description: model, quality, seed and licence.
[[nodiscard]] std::string renderedBy(const std::string& modelName, const std::string& quality, std::uint64_t seed,
                                     const std::string& licence);

/// Figures of a clip in a file: its points and transients, and how far it is from the wave that it was made from.
struct ClipFigures {
    std::string file;
    std::size_t transients = 0;
    clips::WrittenClip written{};
    /// Of what a device with amplitude and frequency plays.
    effects::IntensityErrors intensity{};
};

/// Writes a clip to a file's partial, in the format of its name. Throws InputError that names the file.
clips::WrittenClip writeClipFile(const OutputFile& file, const clips::HapticClip& clip);

/// Writes a clip that was made of a 2 kHz wave, and compares what is played of the file with that wave.
[[nodiscard]] ClipFigures writeAndCompareClip(const OutputFile& file, const clips::HapticClip& clip,
                                              std::span<const float> waveMps2);

/// The errors in perceived intensity of a common motor, which plays its resonance of 160 Hz alone.
[[nodiscard]] effects::IntensityErrors motorErrors(std::span<const float> waveMps2);

/// Prints a note if a clip's points do not follow its amplitude within half a decibel.
void noteCoarseClip(const ClipFigures& figures);

/// Prints what a clip file has and what a motor plays of it; as JSON if `asJson`. Draws it to `picturePath`, an SVG,
/// unless that is empty. Throws InputError that names the file.
void inspectClip(const std::string& path, bool asJson, const std::string& picturePath);

}  // namespace haptoflow::cli
