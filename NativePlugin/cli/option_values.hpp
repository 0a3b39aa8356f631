#pragma once

#include "effects/actuator_profile.hpp"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <string>

namespace haptoflow::cli {

/// Accepts decimal numbers from `lowest` to `highest`; unlike CLI11's own CLI::Range, no "nan", "inf" or hexadecimal.
[[nodiscard]] CLI::Validator decimalBetween(double lowest, double highest, const std::string& unit);

/// Accepts whole numbers in decimal digits from `lowest` to `highest`, without sign. As `transform` it removes leading
/// zeros, which CLI11 would read as octal.
[[nodiscard]] CLI::Validator wholeBetween(std::uint64_t lowest, std::uint64_t highest, const std::string& unit);

/// Accepts the sample rates in Hz that the output of a voice supports.
[[nodiscard]] CLI::Validator outputRate();

/// The built-in actuator profile of this name, otherwise the profile in this file. Throws InputError that names the
/// file and the key.
[[nodiscard]] effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath);

}  // namespace haptoflow::cli
