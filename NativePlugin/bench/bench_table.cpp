#include "bench/bench.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <locale>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

namespace haptoflow::bench {
namespace {

using Json = nlohmann::ordered_json;
using Row = std::vector<std::string>;

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

/// Appends p50, p99 and worst as three cells.
void appendRanks(Row& row, const Json& distribution) {
    for (const char* rank : {"p50", "p99", "worst"}) {
        row.push_back(figure(distribution[rank]));
    }
}

/// The first column is left-aligned, the others are right-aligned; the first row is the heading.
void printTable(std::ostream& stream, const std::string& title, const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const Row& row : rows) {
        for (std::size_t column = 0; column < row.size(); ++column) {
            widths[column] = std::max(widths[column], row[column].size());
        }
    }
    stream << '\n' << title << '\n';
    for (const Row& row : rows) {
        stream << "  " << std::left << std::setw(static_cast<int>(widths[0])) << row[0];
        for (std::size_t column = 1; column < row.size(); ++column) {
            stream << "  " << std::right << std::setw(static_cast<int>(widths[column])) << row[column];
        }
        stream << '\n';
    }
}

void printCallback(std::ostream& stream, const Json& rows) {
    std::vector<Row> table{{"voices", "p50", "p99", "worst", "p99 % of block", "x silence", "paced p50", "p99", "worst",
                            "p99 % of block", "x silence"}};
    for (const Json& entry : rows) {
        Row row{figure(entry["voices"])};
        for (const Json& pace : {entry, entry["paced"]}) {
            appendRanks(row, pace);
            row.push_back(figure(pace["percent_of_block"]["p99"]));
            row.push_back(figure(pace["ratio"]));
        }
        table.push_back(row);
    }
    printTable(stream, "callback, 256 frames at 48 kHz, us", table);
}

void printEffects(std::ostream& stream, const Json& rows) {
    std::vector<Row> table{
        {"effect", "off: runs", "on: us a block", "% of block", "events", "callback p50", "p99", "worst", "x without"}};
    for (const Json& entry : rows) {
        const Json& on = entry["on"];
        Row row{text(entry["name"]), figure(entry["off"]["runs"]), figure(on["us_per_block"]),
                percent(on["share_of_block"]), figure(on["events"])};
        appendRanks(row, on["callback_us"]);
        row.push_back(figure(on["ratio"]));
        table.push_back(row);
    }
    printTable(stream, "effects, 256 frames at 48 kHz, us", table);
}

std::string deviceOf(const Json& entry) {
    const std::string frames = figure(entry["block_frames"]);
    return entry["burst_blocks"] == 1 ? frames : figure(entry["burst_blocks"]) + " x " + frames;
}

void printLatency(std::ostream& stream, const std::string& title, const Json& section) {
    const bool hasFilter = section.contains("filter_delay");
    std::vector<Row> table{
        {"block", "events", "p50", "p99", "worst", "goal", "p99 / goal", "within %", "missed", "late calls"}};
    if (hasFilter) {
        table[0].emplace_back("filter");
    }
    for (const Json& entry : section["rows"]) {
        Row row{deviceOf(entry), figure(entry["count"])};
        appendRanks(row, entry);
        row.insert(row.end(), {figure(entry["goal"]), figure(entry["ratio"]), percent(entry["within_goal"]),
                               figure(entry["missed"]), figure(entry["late_calls"])});
        if (hasFilter) {
            row.push_back(figure(entry["filter_delay"]));
        }
        table.push_back(row);
    }
    printTable(stream, title, table);
}

void printInference(std::ostream& stream, const Json& report) {
    std::vector<Row> table{{"quality", "solver", "steps", "p50", "p99", "worst", "paper / this", "paced p50", "p99",
                            "worst", "paper / this"}};
    const auto add = [&table](const std::string& name, const Json& entry) {
        Row row{name, text(entry["solver"]), figure(entry["steps"])};
        for (const Json& pace : {entry, entry["paced"]}) {
            appendRanks(row, pace);
            row.push_back(figure(pace.value("ratio", Json())));
        }
        table.push_back(row);
    };
    for (const auto& [name, entry] : report["inference_ms"].items()) {
        add(name, entry);
    }
    if (report.contains("paper_architecture_ms")) {
        add("the paper's architecture", report["paper_architecture_ms"]);
    }
    printTable(stream, "inference, one segment on one thread, ms", table);
    if (report.contains("speedup_vs_paper_architecture")) {
        stream << "  speed-up over the paper's architecture, " << text(report["quality"]) << ": "
               << figure(report["speedup_vs_paper_architecture"]) << " hot, "
               << figure(report["speedup_vs_paper_architecture_paced"]) << " paced\n";
    }
}

void printVoices(std::ostream& stream, const std::string& title, const Json& rows) {
    std::vector<Row> table{
        {"voices", "batched p50", "p99", "worst", "one by one p50", "p99", "worst", "batched / one by one"}};
    for (const Json& entry : rows) {
        Row row{figure(entry["count"])};
        appendRanks(row, entry["batched"]);
        appendRanks(row, entry["one_by_one"]);
        row.push_back(figure(entry["ratio"]));
        table.push_back(row);
    }
    printTable(stream, title, table);
}

void printIdle(std::ostream& stream, const Json& idle) {
    printTable(stream, "idle",
               {{"", "inferences", "CPU %", "without engine", "ratio", "worker wakes", "updates"},
                {"no touch", figure(idle["inferences"]), figure(idle["cpu_percent"]),
                 figure(idle["without_engine_cpu_percent"]), figure(idle["ratio"]), figure(idle["worker_wakes"]),
                 figure(idle["updates"])}});
}

void printLoad(std::ostream& stream, const Json& report) {
    const Json& memory = report["memory"];
    printTable(stream, "memory, MiB",
               {{"", "all", "library", "model", "engine", "model file", "all / file"},
                {"resident", figure(report["memory_mib"]), figure(memory["runtime_mib"]), figure(memory["model_mib"]),
                 figure(memory["engine_mib"]), figure(memory["model_file_mib"]), figure(memory["ratio"])}});
    const Json& load = report["load"];
    Row again{"again"};
    appendRanks(again, load["again"]);
    again.insert(again.end(), {figure(load["plain_read"]["p50"]), figure(load["ratio"])});
    printTable(stream, "load, model and engine, ms",
               {{"", "p50", "p99", "worst", "plain read p50", "load / read"}, again});
    const Json& first = load["first"];
    stream << "  the first time: library " << figure(first["runtime_ms"]) << ", model " << figure(first["model_ms"])
           << ", engine " << figure(first["engine_ms"]) << '\n';
}

void printContact(std::ostream& stream, const Json& rows) {
    std::vector<Row> table{{"surfaces", "p50", "p99", "worst", "x smallest", "exact queries", "touching %"}};
    for (const Json& entry : rows) {
        Row row{figure(entry["surfaces"])};
        appendRanks(row, entry);
        row.insert(row.end(), {figure(entry["ratio"]), figure(entry["exact_queries_per_update"]),
                               percent(entry["touching_share"])});
        table.push_back(row);
    }
    printTable(stream, "contact, one frame, us", table);
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
    const auto print = [&](const char* key, auto printSection) {
        if (report.contains(key)) {
            printSection(report[key]);
        }
    };
    print("callback_us", [&](const Json& section) { printCallback(stream, section); });
    print("effects", [&](const Json& section) { printEffects(stream, section); });
    print("onset_ms", [&](const Json& section) { printLatency(stream, "onset, ms", section); });
    print("contact_to_sound_ms", [&](const Json& section) { printLatency(stream, "contact to sound, ms", section); });
    print("stop_ms", [&](const Json& section) { printLatency(stream, "stop, ms", section); });
    print("inference_ms", [&](const Json&) { printInference(stream, report); });
    print("voices", [&](const Json& section) { printVoices(stream, "voices, one update, ms", section); });
    print("sketch_voices",
          [&](const Json& section) { printVoices(stream, "voices of the sketch, one update, ms", section); });
    print("idle", [&](const Json& section) { printIdle(stream, section); });
    print("load", [&](const Json&) { printLoad(stream, report); });
    print("contact", [&](const Json& section) { printContact(stream, section); });
    for (const Json& note : report["notes"]) {
        stream << "\nnote: " << text(note) << '\n';
    }
}

}  // namespace haptoflow::bench
