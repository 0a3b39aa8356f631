#pragma once

#include "clips/clip_formats.hpp"
#include "effects/carrier_rendering.hpp"
#include "effects/wave_features.hpp"
#include "engine/offline_renderer.hpp"
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

struct RenderIdentity {
    std::string name{};
    std::string model{};
    std::vector<std::string> labels{};
    std::string wav{};
    std::string tier{};
    /// Empty for a tier that is evaluated once, without solver and steps.
    std::string solver{};
    int steps = 0;
    double outputRateHz = 0.0;
    /// Touches of the stroke that begin and end between two frames.
    std::uint64_t missedTouches = 0;
    std::vector<ClipFigures> clips{};
};

/// One render as JSON: `name`, `labels`, `wav`, `seconds`, `rms_mps2`, `peak`, `segments`, `inference_ms` {p50, p99},
/// `nonfinite`, `underruns` and the engine's other counts. `solver` and `steps` are null for a tier without them;
/// `clips` is there if clips were written.
[[nodiscard]] std::string renderReport(const RenderIdentity& identity, const engine::OfflineFigures& figures);

/// Collects what a device with one carrier gets for a render.
class ParametricFrames {
public:
    /// `outputRateHz`: a multiple of 2000 Hz. Throws std::invalid_argument.
    explicit ParametricFrames(double outputRateHz);

    /// Processes the next samples, +-1 at `fullScaleMps2`.
    void take(std::span<const float> samples, float fullScaleMps2);
    /// No samples follow. Called once, before what is below.
    void finish();
    /// The frames as JSON; Documentation~/effects-and-outputs.md describes the format.
    [[nodiscard]] std::string toJson() const;
    /// The frames as a table.
    [[nodiscard]] std::string toCsv() const;
    /// The 2 kHz wave in m/s^2.
    [[nodiscard]] std::span<const float> wave() const;

private:
    [[nodiscard]] std::vector<effects::WaveFrame> frames() const;

    effects::WaveDecimation decimation_;
    // The wave at 2 kHz, with the decimation's delay before it and the silence that completes the last frame after it.
    std::vector<float> wave_;
};

}  // namespace haptoflow::cli
