#include "option_values.hpp"

#include "dsp/sample_rates.hpp"
#include "headless/scenes/command_files.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"
#include "recordings/table_rows.hpp"

#include <charconv>
#include <optional>
#include <system_error>
#include <utility>

namespace haptoflow::cli {
namespace {

std::string expectation(const std::string& kind, const std::string& lowest, const std::string& highest,
                        const std::string& unit) {
    return kind + " from " + lowest + " to " + highest + (unit.empty() ? "" : " " + unit);
}

}  // namespace

CLI::Validator decimalBetween(double lowest, double highest, const std::string& unit) {
    const std::string expected = expectation("a number", model::shortNumber(lowest), model::shortNumber(highest), unit);
    const auto check = [lowest, highest, expected](std::string& text) {
        const std::optional<double> value = recordings::decimalNumber(text);
        return value && *value >= lowest && *value <= highest ? std::string()
                                                              : "expected " + expected + ", found '" + text + "'";
    };
    return {check, model::shortNumber(lowest) + " to " + model::shortNumber(highest), expected};
}

CLI::Validator wholeBetween(std::uint64_t lowest, std::uint64_t highest, const std::string& unit) {
    const std::string expected = expectation("a whole number", std::to_string(lowest), std::to_string(highest), unit);
    const auto check = [lowest, highest, expected](std::string& text) {
        std::uint64_t value = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, error] = std::from_chars(text.data(), end, value);
        if (error != std::errc() || stop != end || value < lowest || value > highest) {
            return "expected " + expected + ", found '" + text + "'";
        }
        // CLI11 would read a leading zero as octal.
        text = std::to_string(value);
        return std::string();
    };
    return {check, std::to_string(lowest) + " to " + std::to_string(highest), expected};
}

CLI::Validator outputRate() {
    return wholeBetween(static_cast<std::uint64_t>(dsp::minimumOutputRateHz),
                        static_cast<std::uint64_t>(dsp::maximumOutputRateHz), "Hz");
}

effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath) {
    if (std::optional<effects::ActuatorProfile> builtIn = effects::ActuatorProfile::builtIn(nameOrPath)) {
        return *std::move(builtIn);
    }
    const std::string text =
        headless::readInputFile("the actuator profile", nameOrPath,
                                "an actuator profile (JSON), or the name of a built-in one: flat, voice-coil");
    try {
        return effects::ActuatorProfile::parse(text);
    } catch (const effects::ProfileError& error) {
        throw InputError(nameOrPath + ": " + error.what());
    }
}

}  // namespace haptoflow::cli
