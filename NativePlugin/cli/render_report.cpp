#include "render_report.hpp"

#include "exit_codes.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>

namespace haptoflow::cli {
namespace {

double percentile(std::vector<double> values, double share) {
    if (values.empty()) {
        return 0.0;
    }
    std::ranges::sort(values);
    const auto last = static_cast<double>(values.size() - 1);
    return values[static_cast<std::size_t>(std::lround(share * last))];
}

}  // namespace

void writeRenderReport(const std::filesystem::path& path, const RenderIdentity& identity,
                       const engine::OfflineRender& render) {
    const nlohmann::ordered_json report{
        {"name", identity.name},
        {"model", identity.model},
        {"labels", identity.labels},
        {"wav", identity.wav},
        {"seconds", static_cast<double>(render.samples.size()) / identity.outputRateHz},
        {"rms_mps2", render.rmsMps2},
        {"peak", render.peak},
        {"segments", render.inferenceMs.size()},
        {"inference_ms", {{"p50", percentile(render.inferenceMs, 0.5)}, {"p99", percentile(render.inferenceMs, 0.99)}}},
        {"nonfinite", render.nonFinite},
        {"underruns", render.underruns},
        {"solver", identity.solver},
        {"steps", identity.steps},
        {"touches", render.onsets},
        {"skipped", render.skipped},
        {"failures", render.failures},
        {"sanitised", render.sanitised},
        {"limited_samples", render.limited},
        {"seams",
         {{"count", render.seamStatistics.seams},
          {"outlier_share", render.seamStatistics.outlierShare},
          {"jump_ratio", render.seamStatistics.jumpRatio}}},
    };
    std::ofstream file(path);
    file << report.dump(2) << '\n';
    if (!file.flush()) {
        throw InputError(path.string() + ": cannot be written: name a file in a folder that exists");
    }
}

}  // namespace haptoflow::cli
