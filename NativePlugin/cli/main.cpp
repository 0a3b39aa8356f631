#include "commands.hpp"
#include "headless/command_files.hpp"
#include "messages.hpp"
#include "option_values.hpp"

#include "inference/load_limits.hpp"
#include "model/model_error.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>
#include <vector>

namespace {

std::vector<const CLI::App*> subcommandsOf(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// The subcommand that the command line begins with; null if there is none.
const CLI::App* subcommandIn(const CLI::App& app, const std::vector<std::string>& words) {
    const std::vector<const CLI::App*> all = subcommandsOf(app);
    const auto found = std::ranges::find_if(all, [&words](const CLI::App* subcommand) {
        return !words.empty() && subcommand->get_name() == words.front();
    });
    return found == all.end() ? nullptr : *found;
}

/// Throws UsageError if the first word is not a subcommand.
void requireSubcommand(const CLI::App& app, const std::vector<std::string>& words) {
    if (words.empty() || words.front().starts_with('-') || subcommandsOf(app).empty()) {
        return;
    }
    if (const CLI::App* subcommand = subcommandIn(app, words)) {
        requireSubcommand(*subcommand, {words.begin() + 1, words.end()});
        return;
    }
    std::vector<std::string> names;
    for (const CLI::App* subcommand : subcommandsOf(app)) {
        names.push_back(subcommand->get_name());
    }
    const std::string meant = haptoflow::headless::suggestion(words.front(), names);
    const std::string place = app.get_parent() == nullptr ? "" : app.get_name() + ' ';
    throw haptoflow::cli::UsageError("there is no command '" + place + words.front() + "'; " +
                                     (meant.empty() ? "" : meant + " ") + "The commands are " +
                                     haptoflow::cli::listed(names));
}

/// Prints a suggestion for each misspelt option.
void suggestOptions(const CLI::App& app, const std::vector<std::string>& words) {
    if (const CLI::App* subcommand = subcommandIn(app, words)) {
        suggestOptions(*subcommand, {words.begin() + 1, words.end()});
        return;
    }
    std::vector<std::string> known;
    for (const CLI::Option* option : app.get_options()) {
        for (const std::string& name : option->get_lnames()) {
            known.push_back("--" + name);
        }
    }
    for (const std::string& word : words) {
        const std::string option = word.substr(0, word.find('='));
        if (option.starts_with("--") && option.size() > 2 && std::ranges::find(known, option) == known.end()) {
            const std::string meant = haptoflow::headless::suggestion(option, known);
            std::cerr << "There is no option '" << option << "'" << (meant.empty() ? "" : "; " + meant) << '\n';
        }
    }
}

int run(int argc, char** argv) {
    using namespace haptoflow::cli;

    CLI::App app{"HaptoFlow: renders the vibration of a stylus stroke over surfaces with material labels."};
    app.name("haptoflow");
    app.set_version_flag("--version", HAPTOFLOW_VERSION);
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  haptoflow render scene.json --stroke stroke.csv -o stroke.wav\n"
        "  haptoflow contact scene.json --stroke stroke.csv\n"
        "  haptoflow inspect default.haptoflow\n"
        "  haptoflow actuator show voice-coil\n"
        "  haptoflow learn denim.csv -o denim.haptomaterial\n"
        "  haptoflow export-set -o clips --labels wood,sandpaper\n"
        "  haptoflow bench --quick\n"
        "Exit codes: 0 done, 2 wrong usage, 3 bad input file, 4 internal error.");

    addRenderCommand(app);
    addContactCommand(app);
    addInspectCommand(app);
    addActuatorCommand(app);
    addLearnCommand(app);
    addExportSetCommand(app);
    addBenchCommand(app);

    const std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
    try {
        requireSubcommand(app, words);
        app.parse(argc, argv);
        return exitDone;
    } catch (const CLI::ParseError& error) {
        if (app.exit(error) == 0) {
            return exitDone;
        }
        suggestOptions(app, words);
        return exitUsage;
    } catch (const UsageError& error) {
        complain(error.what());
        return exitUsage;
    } catch (const InputError& error) {
        complain(error.what());
        return exitBadInput;
    } catch (const haptoflow::model::ModelError& error) {
        // An error in one of the model's graphs, found when it is loaded into ONNX Runtime.
        complain(std::string("model: ") + error.what());
        return exitBadInput;
    } catch (const haptoflow::inference::TierTooSlow& error) {
        complain(std::string("model: ") + error.what());
        return exitBadInput;
    } catch (const std::exception& error) {
        complain(std::string("internal error: ") + error.what());
        return exitInternal;
    }
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (...) {
        // Writing the first message failed; fputs does not throw.
        (void)std::fputs("haptoflow: internal error\n", stderr);
        return haptoflow::cli::exitInternal;
    }
}
