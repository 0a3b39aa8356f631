#pragma once

#include "headless/contact_tracker.hpp"
#include "headless/stroke_file.hpp"

#include <CLI/CLI.hpp>

#include <iosfwd>
#include <string>

namespace haptoflow::cli {

/// Each function adds one subcommand, whose callback runs it. Errors in input files are thrown as InputError; main
/// prints them and exits with code 3.
void addRenderCommand(CLI::App& app);
void addContactCommand(CLI::App& app);
void addInspectCommand(CLI::App& app);
void addActuatorCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);
void addLearnCommand(CLI::App& app);
void addExportSetCommand(CLI::App& app);

/// Plays the stroke in the scene at the scene's update rate, or in frames at its own samples, and writes one CSV line
/// per frame. Throws InputError if the stroke, named `strokeName`, is too long.
void writeContactStates(std::ostream& output, const headless::Scene& scene, const headless::Stroke& stroke,
                        const std::string& strokeName, const headless::ContactSettings& settings,
                        bool asRecorded = false);

}  // namespace haptoflow::cli
