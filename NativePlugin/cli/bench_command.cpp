#include "bench/bench.hpp"

#include "commands.hpp"
#include "headless/command_files.hpp"
#include "inference/onnx_runtime.hpp"
#include "messages.hpp"
#include "option_values.hpp"
#include "output_file.hpp"

#include <nlohmann/json.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

struct BenchCommandOptions {
    std::string modelPath;
    std::string paperModelPath;
    std::string outputPath;
    std::vector<std::string> only;
    std::optional<std::size_t> events;
    bool quick = false;
    bool json = false;
    bool quiet = false;
};

bench::SubjectFiles filesOf(const BenchCommandOptions& options) {
    if (!options.paperModelPath.empty()) {
        headless::claimInput("--paper-model", options.paperModelPath);
    }
    return {.runtimeLibrary = findOnnxRuntime(),
            .model = findModel(options.modelPath),
            .paperModel = options.paperModelPath};
}

nlohmann::ordered_json measure(const BenchCommandOptions& options, const bench::SubjectFiles& files) {
    bench::BenchOptions wanted;
    wanted.files = files;
    wanted.plan = options.quick ? bench::BenchPlan::quick() : bench::BenchPlan::full();
    wanted.plan.events = options.events.value_or(wanted.plan.events);
    wanted.only = options.only;
    wanted.version = HAPTOFLOW_VERSION;
    try {
        return bench::runBench(wanted, progressBar("bench", options.quiet));
    } catch (const model::ModelError& error) {
        throw InputError(error.what());
    } catch (const inference::RuntimeUnavailable& error) {
        throw InputError(error.what());
    }
}

void runBench(const BenchCommandOptions& options) {
    const bench::SubjectFiles files = filesOf(options);
    // Checked before minutes of measuring: the file must be writable.
    const OptionalOutput output = optionalOutput("-o", options.outputPath);
    const nlohmann::ordered_json report = measure(options, files);
    const std::string text = report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
    if (options.json) {
        resultStream() << text;
    } else {
        bench::printTables(resultStream(), report);
    }
    writeText(output, text);
    commit(output);
}

}  // namespace

void addBenchCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("bench", "Measure callback, latencies, inference and memory");
    const auto options = std::make_shared<BenchCommandOptions>();
    command->add_option("--model", options->modelPath, "Model file (default: the one shipped)")->type_name("FILE");
    command
        ->add_option("--paper-model", options->paperModelPath,
                     "Model file of the paper's architecture, for comparison (`npm run bench` builds one)")
        ->type_name("FILE");
    command->add_flag("--quick", options->quick, "Fewer events and devices: half a minute for a first look");
    command
        ->add_option("--only", options->only,
                     "Only these measurements: callback, effects, latency, inference, voices, idle")
        ->delimiter(',')
        ->check(
            CLI::IsMember(std::vector<std::string>(bench::measurementNames.begin(), bench::measurementNames.end())));
    command
        ->add_option("--events", options->events,
                     "Events of each latency measurement; all other counts scale with it (default: 120, quick 24). "
                     "Below 100 the p99 is the worst")
        ->transform(wholeBetween(1, 10000, ""));
    command->add_flag("--json", options->json, "Print the report as JSON instead of tables");
    command->add_option("-o,--output", options->outputPath, "Also write the report as JSON")->type_name("BENCH.json");
    command->add_flag("--quiet", options->quiet, "No progress bar");
    command->footer(
        "Examples:\n"
        "  haptoflow bench --quick\n"
        "  haptoflow bench --only inference --paper-model paper.haptoflow --json\n"
        "Keep the machine idle while it runs: other programs slow down every measurement.");
    command->callback([options] { runBench(*options); });
}

}  // namespace haptoflow::cli
