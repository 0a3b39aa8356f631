#include "bench/bench.hpp"

#include "bench/latency_bench.hpp"
#include "bench/measurements.hpp"
#include "model/plain_text.hpp"

#include <algorithm>

namespace haptoflow::bench {
namespace {

struct Measurement {
    std::string_view name;
    /// Approximate share of a whole run's time, for the progress bar.
    double weight;
    std::function<nlohmann::ordered_json(const Advance&)> run;
};

nlohmann::ordered_json identity(const std::filesystem::path& path, const model::ModelFile& model) {
    return {{"name", model.header().name},
            {"file", path.filename().string()},
            {"crc32", model::hexadecimal(model.checksum())},
            {"provenance", model.header().provenance.statement}};
}

nlohmann::ordered_json notesFor(const nlohmann::ordered_json& report, const Subjects& subjects) {
    nlohmann::ordered_json notes = nlohmann::ordered_json::array();
    if (report.contains("inference_ms") && subjects.paper == nullptr) {
        notes.push_back(
            "speedup_vs_paper_architecture was not measured: there is no model of the paper's architecture; "
            "`npm run bench` builds one, --paper-model names one");
    }
    if (report.contains("onset_ms") && !report.contains("contact_to_sound_ms")) {
        notes.push_back("contact_to_sound_ms was not measured: it needs a model with a skeleton and two labels");
    }
    return notes;
}

}  // namespace

nlohmann::ordered_json runBench(const BenchOptions& options, const BenchProgress& progress) {
    const BenchPlan& plan = options.plan;
    nlohmann::ordered_json loading;
    progress(0.0, "load");
    const nlohmann::ordered_json loadBefore = loadAverage();
    const Subjects subjects = openSubjects(options.files, options.seed, loading);

    const std::vector<Measurement> all{
        {"callback", 14.0, [&](const Advance& advance) { return measureCallback(subjects, plan, advance); }},
        {"effects", 8.0, [&](const Advance& advance) { return measureEffects(subjects, plan, advance); }},
        {"latency", 130.0, [&](const Advance& advance) { return measureLatency(subjects, plan, advance); }},
        {"inference", 35.0, [&](const Advance& advance) { return measureInference(subjects, plan, advance); }},
        {"voices", 10.0, [&](const Advance& advance) { return measureVoices(subjects, plan, advance); }},
        {"idle", 6.0, [&](const Advance& advance) { return measureIdle(subjects, plan, advance); }},
    };
    std::vector<Measurement> chosen;
    double total = 5.0;
    for (const Measurement& measurement : all) {
        if (options.only.empty() || std::ranges::find(options.only, measurement.name) != options.only.end()) {
            chosen.push_back(measurement);
            total += measurement.weight;
        }
    }
    double done = 0.0;
    const auto advanceOf = [&](std::string_view name, double weight) {
        return
            [&progress, &done, total, name, weight](double share) { progress((done + weight * share) / total, name); };
    };
    measureLoads(options.files, subjects, plan, advanceOf("load", 5.0), loading);
    done = 5.0;
    nlohmann::ordered_json measured;
    for (const Measurement& measurement : chosen) {
        progress(done / total, measurement.name);
        measured.update(measurement.run(advanceOf(measurement.name, measurement.weight)));
        done += measurement.weight;
    }
    progress(1.0, "done");

    nlohmann::ordered_json report{{"haptoflow", options.version},
                                  {"date", today()},
                                  {"model", identity(options.files.model, *subjects.model)},
                                  {"quality", subjects.standard().name}};
    if (subjects.paper != nullptr) {
        report["paper_model"] = identity(options.files.paperModel, *subjects.paper);
    }
    report["machine"] = machineWords(subjects.runtime->version());
    report["machine"]["load_average"] = {{"before", loadBefore}, {"after", loadAverage()}};
    report["events"] = plan.events;
    report["update_rate_hz"] = updateRateHz;
    report["sample_rate_hz"] = outputRateHz;
    report.update(measured);
    report.update(loading);
    report["notes"] = notesFor(report, subjects);
    return report;
}

}  // namespace haptoflow::bench
