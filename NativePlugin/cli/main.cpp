#include "commands.hpp"
#include "exit_codes.hpp"

#include <CLI/CLI.hpp>

#include <exception>
#include <iostream>

namespace {

int run(int argc, char** argv) {
    using namespace haptoflow::cli;

    CLI::App app{"HaptoFlow: what a stylus stroke across tagged surfaces feels like."};
    app.name("haptoflow");
    app.set_version_flag("--version", HAPTOFLOW_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  haptoflow render scene.json --stroke stroke.csv -o felt.wav\n"
        "  haptoflow contact scene.json --stroke stroke.csv\n"
        "  haptoflow inspect default.haptoflow\n"
        "  haptoflow bench --quick\n"
        "Exit codes: 0 done, 2 wrong usage, 3 bad input file, 4 internal error.");

    CommandOutcome outcome;
    addRenderCommand(app, outcome);
    addContactCommand(app, outcome);
    addInspectCommand(app, outcome);
    addBenchCommand(app, outcome);

    try {
        app.parse(argc, argv);
        return outcome.exitCode;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exitDone : exitUsage;
    } catch (const UsageError& error) {
        std::cerr << "haptoflow: " << error.what() << '\n';
        return exitUsage;
    } catch (const InputError& error) {
        std::cerr << "haptoflow: " << error.what() << '\n';
        return exitBadInput;
    } catch (const std::exception& error) {
        std::cerr << "haptoflow: internal error: " << error.what() << '\n';
        return exitInternal;
    }
}

}  // namespace

int main(int argc, char** argv) {
    return run(argc, argv);
}
