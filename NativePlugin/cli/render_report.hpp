#pragma once

#include "engine/offline_renderer.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace haptoflow::cli {

struct RenderIdentity {
    std::string name{};
    std::string model{};
    std::vector<std::string> labels{};
    std::string wav{};
    std::string solver{};
    int steps = 0;
    double outputRateHz = 0.0;
};

/// One render as JSON: `name`, `labels`, `wav`, `seconds`, `rms_mps2`, `peak`, `segments`, `inference_ms` {p50, p99},
/// `nonfinite`, `underruns`, and what else the engine counted. Throws InputError naming the path.
void writeRenderReport(const std::filesystem::path& path, const RenderIdentity& identity,
                       const engine::OfflineRender& render);

}  // namespace haptoflow::cli
