#include "exponential_sweep.hpp"

#include "recordings/table_rows.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

namespace haptoflow::cli {
namespace {

constexpr std::string_view title = "haptoflow sweep:";

std::string shortestText(double value) {
    std::array<char, 32> digits{};
    const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
    return {digits.data(), end};
}

std::optional<double> valueOf(std::string_view text, std::string_view key) {
    const std::string assignment = " " + std::string(key) + "=";
    const std::size_t at = text.find(assignment);
    if (at == std::string_view::npos) {
        return std::nullopt;
    }
    const std::string_view rest = text.substr(at + assignment.size());
    return recordings::decimalNumber(rest.substr(0, rest.find(' ')));
}

}  // namespace

double ExponentialSweep::secondsPerNeper() const {
    return seconds / std::log(toHz / fromHz);
}

std::vector<float> ExponentialSweep::samples(double rateHz) const {
    const double neper = secondsPerNeper();
    const double fade = std::min(fadeOctaves * std::numbers::ln2 * neper, 0.25 * seconds);
    std::vector<float> result(static_cast<std::size_t>(std::llround(seconds * rateHz)));
    for (std::size_t i = 0; i < result.size(); ++i) {
        const double time = static_cast<double>(i) / rateHz;
        const double cycles = fromHz * neper * std::expm1(time / neper);
        const double share = std::clamp(std::min(time, seconds - time) / fade, 0.0, 1.0);
        const double gain = 0.5 - 0.5 * std::cos(std::numbers::pi * share);
        // Only the fraction of the turns: the sine of a large number is slower and no more accurate.
        result[i] = static_cast<float>(level * gain * std::sin(2.0 * std::numbers::pi * (cycles - std::floor(cycles))));
    }
    return result;
}

std::string ExponentialSweep::describe() const {
    return std::string(title) + " seconds=" + shortestText(seconds) + " from_hz=" + shortestText(fromHz) +
           " to_hz=" + shortestText(toHz) + " level=" + shortestText(level);
}

std::optional<ExponentialSweep> ExponentialSweep::parse(std::string_view text) {
    if (!text.starts_with(title)) {
        return std::nullopt;
    }
    const auto seconds = valueOf(text, "seconds");
    const auto fromHz = valueOf(text, "from_hz");
    const auto toHz = valueOf(text, "to_hz");
    const auto level = valueOf(text, "level");
    const bool isSweep = seconds && fromHz && toHz && level && *seconds >= 1.0 && *seconds <= 120.0 && *fromHz >= 1.0 &&
                         *toHz >= 2.0 * *fromHz && *toHz <= 20000.0 && *level > 0.0 && *level <= 1.0;
    if (!isSweep) {
        return std::nullopt;
    }
    return ExponentialSweep{.seconds = *seconds, .fromHz = *fromHz, .toHz = *toHz, .level = *level};
}

}  // namespace haptoflow::cli
