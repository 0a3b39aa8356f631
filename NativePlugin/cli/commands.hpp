#pragma once

#include <CLI/CLI.hpp>

namespace haptoflow::cli {

/// The result of a command for main: the process's exit code (see messages.hpp).
struct CommandOutcome {
    int exitCode = 0;
};

/// Each function adds one subcommand, whose callback runs it and stores its exit code in `outcome`. Errors in input
/// files are thrown as InputError; main prints them and exits with code 3.
void addRenderCommand(CLI::App& app, CommandOutcome& outcome);
void addContactCommand(CLI::App& app, CommandOutcome& outcome);
void addInspectCommand(CLI::App& app, CommandOutcome& outcome);
void addActuatorCommand(CLI::App& app, CommandOutcome& outcome);
void addBenchCommand(CLI::App& app, CommandOutcome& outcome);
void addLearnCommand(CLI::App& app, CommandOutcome& outcome);

}  // namespace haptoflow::cli
