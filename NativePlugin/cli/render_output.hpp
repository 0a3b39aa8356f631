#pragma once

#include "clip_output.hpp"
#include "effects/wave_features.hpp"
#include "engine/offline_renderer.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {

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
