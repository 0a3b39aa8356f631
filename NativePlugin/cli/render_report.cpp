#include "render_report.hpp"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace haptoflow::cli {

namespace {

/// For each effect that ran: its impacts or edges, and the samples that it processed.
nlohmann::ordered_json effectsOf(const engine::OfflineFigures& figures) {
    constexpr std::array<const char*, effects::effectKinds> names{
        "texture", "impact", "edge", "delay", "compensation", "exposure guard", "tone", "signal", "listen"};
    nlohmann::ordered_json effects = nlohmann::ordered_json::object();
    for (std::size_t kind = 0; kind < names.size(); ++kind) {
        if (figures.effectSamples[kind] > 0 || figures.effectEvents[kind] > 0) {
            effects[names[kind]] = {{"events", figures.effectEvents[kind]}, {"samples", figures.effectSamples[kind]}};
        }
    }
    return effects;
}

}  // namespace

std::string renderReport(const RenderIdentity& identity, const engine::OfflineFigures& figures) {
    const bool isSolved = !identity.solver.empty();
    const nlohmann::ordered_json report{
        {"name", identity.name},
        {"model", identity.model},
        {"labels", identity.labels},
        {"wav", identity.wav},
        {"seconds", static_cast<double>(figures.outputSamples) / identity.outputRateHz},
        {"rms_mps2", figures.rmsMps2},
        {"peak", figures.peak},
        {"segments", figures.segments},
        {"inference_ms", {{"p50", figures.inferenceMsMedian}, {"p99", figures.inferenceMsP99}}},
        {"nonfinite", figures.nonFinite},
        {"underruns", figures.underruns},
        {"sketched", figures.sketched},
        {"tier", identity.tier},
        {"solver", isSolved ? nlohmann::ordered_json(identity.solver) : nlohmann::ordered_json()},
        {"steps", isSolved ? nlohmann::ordered_json(identity.steps) : nlohmann::ordered_json()},
        {"touches", figures.touches},
        {"silent_touches", figures.silentTouches},
        {"missed_touches", identity.missedTouches},
        {"onsets", figures.onsets},
        {"skipped", figures.skipped},
        {"failures", figures.failures},
        {"sanitised", figures.sanitised},
        {"limited_samples", figures.limited},
        {"effects", effectsOf(figures)},
        {"seams",
         {{"count", figures.seamStatistics.seams},
          {"outlier_share", figures.seamStatistics.outlierShare},
          {"jump_ratio", figures.seamStatistics.jumpRatio}}},
    };
    return report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

}  // namespace haptoflow::cli
