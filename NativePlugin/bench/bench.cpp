#include "bench/bench.hpp"

#include "bench/latency_bench.hpp"
#include "bench/measurements.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <ostream>
#include <sstream>

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

namespace {

using Json = nlohmann::ordered_json;

/// A number with three significant digits and no exponent; a dash if it was not measured.
std::string figure(const Json& value) {
    if (!value.is_number()) {
        return "-";
    }
    const double number = value.get<double>();
    const int magnitude = number == 0.0 ? 0 : static_cast<int>(std::floor(std::log10(std::abs(number))));
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << std::fixed << std::setprecision(value.is_number_integer() ? 0 : std::clamp(2 - magnitude, 0, 4))
           << number;
    return stream.str();
}

std::string percent(const Json& share) {
    return figure(Json(100.0 * share.get<double>()));
}

std::string text(const Json& value) {
    return value.get<std::string>();
}

std::string deviceOf(const Json& entry) {
    const std::string frames = figure(entry["block_frames"]);
    return entry["burst_blocks"] == 1 ? frames : figure(entry["burst_blocks"]) + " x " + frames;
}

struct Column {
    std::string heading;
    /// JSON pointer of the value in a row's entry.
    std::string pointer;
    std::string (*show)(const Json&) = figure;
};
using Columns = std::vector<Column>;

/// The figures of one section of the report.
struct Table {
    std::string key;
    std::string title;
    Columns columns;
};

/// p50, p99 and worst of the distribution at a pointer.
Columns ranks(const std::string& pointer, const std::string& what = "") {
    return {{what + "p50", pointer + "/p50"}, {"p99", pointer + "/p99"}, {"worst", pointer + "/worst"}};
}

Columns joined(std::initializer_list<Columns> parts) {
    Columns all;
    for (const Columns& part : parts) {
        all.insert(all.end(), part.begin(), part.end());
    }
    return all;
}

std::vector<Table> tables() {
    const Columns latency = joined({{{"block", "", deviceOf}, {"events", "/count"}},
                                    ranks(""),
                                    {{"goal", "/goal"},
                                     {"p99 / goal", "/ratio"},
                                     {"within %", "/within_goal", percent},
                                     {"missed", "/missed"},
                                     {"late calls", "/late_calls"},
                                     {"filter", "/filter_delay"}}});
    const Columns voices = joined({{{"voices", "/count"}},
                                   ranks("/batched", "batched "),
                                   ranks("/one_by_one", "one by one "),
                                   {{"batched / one by one", "/ratio"}}});
    return {{"callback_us", "callback, 256 frames at 48 kHz, us",
             joined({{{"voices", "/voices"}},
                     ranks(""),
                     {{"p99 % of block", "/percent_of_block/p99"}, {"x silence", "/ratio"}},
                     ranks("/paced", "paced "),
                     {{"p99 % of block", "/paced/percent_of_block/p99"}, {"x silence", "/paced/ratio"}}})},
            {"effects", "effects, 256 frames at 48 kHz, us",
             joined({{{"effect", "/name", text},
                      {"off: runs", "/off/runs"},
                      {"on: us a block", "/on/us_per_block"},
                      {"% of block", "/on/share_of_block", percent},
                      {"events", "/on/events"}},
                     ranks("/on/callback_us", "callback "),
                     {{"x without", "/on/ratio"}}})},
            {"onset_ms", "onset, ms", latency},
            {"contact_to_sound_ms", "contact to sound, ms", latency},
            {"stop_ms", "stop, ms", latency},
            {"inference_ms", "inference, one segment on one thread, ms",
             joined({{{"quality", "/name", text}, {"solver", "/solver", text}, {"steps", "/steps"}},
                     ranks(""),
                     {{"paper / this", "/ratio"}},
                     ranks("/paced", "paced "),
                     {{"paper / this", "/paced/ratio"}}})},
            {"voices", "voices, one update, ms", voices},
            {"sketch_voices", "voices of the sketch, one update, ms", voices},
            {"idle",
             "idle",
             {{"inferences", "/inferences"},
              {"CPU %", "/cpu_percent"},
              {"without engine", "/without_engine_cpu_percent"},
              {"ratio", "/ratio"},
              {"worker wakes", "/worker_wakes"},
              {"updates", "/updates"}}},
            {"memory",
             "memory, MiB",
             {{"library", "/runtime_mib"},
              {"model", "/model_mib"},
              {"engine", "/engine_mib"},
              {"model file", "/model_file_mib"},
              {"all / file", "/ratio"}}},
            {"load", "load, model and engine, ms",
             joined({ranks("/again"),
                     {{"plain read p50", "/plain_read/p50"},
                      {"load / read", "/ratio"},
                      {"first time: library", "/first/runtime_ms"},
                      {"model", "/first/model_ms"},
                      {"engine", "/first/engine_ms"}}})}};
}

/// The JSON objects of a report's section from which the rows of its table are made, in the order of the rows.
Json entriesOf(const Json& report, const std::string& key) {
    const Json& section = report[key];
    if (key == "inference_ms") {
        Json entries = Json::array();
        const auto add = [&entries](const std::string& name, const Json& entry) {
            entries.push_back(entry);
            entries.back()["name"] = name;
        };
        for (const auto& [name, entry] : section.items()) {
            add(name, entry);
        }
        if (report.contains("paper_architecture_ms")) {
            add("the paper's architecture", report["paper_architecture_ms"]);
        }
        return entries;
    }
    return section.is_array() ? section : section.contains("rows") ? section["rows"] : Json::array({section});
}

/// The first column is left-aligned, the others are right-aligned; the first row is the heading.
void printTable(std::ostream& stream, const Table& table, const Json& entries) {
    std::vector<std::vector<std::string>> columns;
    for (const Column& column : table.columns) {
        std::vector<std::string>& cells = columns.emplace_back(1, column.heading);
        for (const Json& entry : entries) {
            cells.push_back(column.show(entry.value(Json::json_pointer(column.pointer), Json())));
        }
    }
    stream << '\n' << table.title << '\n';
    for (std::size_t row = 0; row <= entries.size(); ++row) {
        for (const std::vector<std::string>& cells : columns) {
            const std::size_t width = std::ranges::max(cells, {}, &std::string::size).size();
            stream << "  " << (&cells == &columns.front() ? std::left : std::right)
                   << std::setw(static_cast<int>(width)) << cells[row];
        }
        stream << '\n';
    }
}

}  // namespace

void printTables(std::ostream& stream, const Json& report) {
    const Json& machine = report["machine"];
    stream << "HaptoFlow " << text(report["haptoflow"]) << ", model " << text(report["model"]["name"]) << " ("
           << text(report["model"]["crc32"]) << "), quality " << text(report["quality"]) << ", " << text(report["date"])
           << '\n'
           << text(machine["processor"]) << ", " << figure(machine["cores"]) << " cores, " << text(machine["system"])
           << ", ONNX Runtime " << text(machine["onnxruntime"]) << ", load average "
           << figure(machine["load_average"]["before"]) << " before, " << figure(machine["load_average"]["after"])
           << " after\n";
    for (const Table& table : tables()) {
        if (report.contains(table.key)) {
            printTable(stream, table, entriesOf(report, table.key));
        }
    }
    if (report.contains("speedup_vs_paper_architecture")) {
        stream << "  speed-up over the paper's architecture, " << text(report["quality"]) << ": "
               << figure(report["speedup_vs_paper_architecture"]) << " hot, "
               << figure(report["speedup_vs_paper_architecture_paced"]) << " paced\n";
    }
    for (const Json& note : report["notes"]) {
        stream << "\nnote: " << text(note) << '\n';
    }
}

}  // namespace haptoflow::bench
