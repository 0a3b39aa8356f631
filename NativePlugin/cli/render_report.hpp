#pragma once

#include "engine/offline_renderer.hpp"

#include <cstdint>
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
};

/// One render as JSON: `name`, `labels`, `wav`, `seconds`, `rms_mps2`, `peak`, `segments`, `inference_ms` {p50, p99},
/// `nonfinite`, `underruns` and the engine's other counts. `solver` and `steps` are null for a tier without them.
[[nodiscard]] std::string renderReport(const RenderIdentity& identity, const engine::OfflineFigures& figures);

}  // namespace haptoflow::cli
