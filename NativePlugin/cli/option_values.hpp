#pragma once

#include "effects/actuator_profile.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace haptoflow::cli {

/// Takes decimal numbers from `lowest` to `highest` and nothing else: no "nan", no "inf", no hexadecimal.
[[nodiscard]] CLI::Validator decimalBetween(double lowest, double highest, const std::string& unit);

/// Takes whole numbers in decimal digits from `lowest` to `highest`: no sign, and as `transform` no leading zero that
/// CLI11 would read as octal.
[[nodiscard]] CLI::Validator wholeBetween(std::uint64_t lowest, std::uint64_t highest, const std::string& unit);

/// Takes the sample rates that the output of a voice supports, in Hz.
[[nodiscard]] CLI::Validator outputRate();

/// The built-in actuator profile of this name, otherwise the profile in this file. Throws InputError that names the file
/// and the key.
[[nodiscard]] effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath);

}  // namespace haptoflow::cli
