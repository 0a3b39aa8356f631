#pragma once

#include <CLI/CLI.hpp>

namespace haptoflow::cli {

/// What a command leaves behind for main: the process's exit code (see exit_codes.hpp).
struct CommandOutcome {
    int exitCode = 0;
};

/// Each adds one subcommand whose callback runs it and stores its exit code in `outcome`.
/// Errors of the input are thrown as InputError; main prints them and turns them into exit code 3.
void addRenderCommand(CLI::App& app, CommandOutcome& outcome);
void addContactCommand(CLI::App& app, CommandOutcome& outcome);
void addInspectCommand(CLI::App& app, CommandOutcome& outcome);
void addActuatorCommand(CLI::App& app, CommandOutcome& outcome);
void addBenchCommand(CLI::App& app, CommandOutcome& outcome);
void addLearnCommand(CLI::App& app, CommandOutcome& outcome);

}  // namespace haptoflow::cli
