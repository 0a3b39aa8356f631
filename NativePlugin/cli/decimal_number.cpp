#include "decimal_number.hpp"

#include <charconv>
#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>
#include <string>
#include <system_error>
#include <version>

namespace haptoflow::cli {
namespace {

#ifdef __cpp_lib_to_chars

std::optional<double> unsignedOrNegative(std::string_view text) {
    double value = 0.0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || stop != text.data() + text.size()) {
        return std::nullopt;
    }
    return value;
}

#else

// Before version 20, libc++'s from_chars reads whole numbers only.
std::optional<double> unsignedOrNegative(std::string_view text) {
    if (text.empty() || text.find_first_not_of("0123456789.eE+-") != std::string_view::npos || text.front() == '+') {
        return std::nullopt;
    }
    std::istringstream stream{std::string(text)};
    stream.imbue(std::locale::classic());
    double value = 0.0;
    stream >> value;
    if (stream.fail() || stream.peek() != std::istringstream::traits_type::eof()) {
        return std::nullopt;
    }
    return value;
}

#endif

struct Parts {
    double whole = 0.0;
    double fraction = 0.0;
};

/// A decimal before and after its point; a number with an exponent is its whole part.
std::optional<Parts> partsOf(std::string_view text) {
    const std::optional<double> value = decimalNumber(text);
    const std::size_t point = text.find('.');
    if (!value || point == std::string_view::npos || text.find_first_of("eE") != std::string_view::npos) {
        return value ? std::optional(Parts{.whole = *value}) : std::nullopt;
    }
    // Not the truncated value, which may have been rounded up.
    const std::optional<double> whole = decimalNumber(text.substr(0, point));
    const std::optional<double> fraction = decimalNumber("0" + std::string(text.substr(point)));
    return Parts{.whole = whole.value_or(0.0), .fraction = std::copysign(fraction.value_or(0.0), *value)};
}

}  // namespace

std::optional<double> decimalNumber(std::string_view text) {
    if (text.starts_with('+') && !text.starts_with("+-")) {
        text.remove_prefix(1);
    }
    return unsignedOrNegative(text);
}

std::optional<double> decimalDifference(std::string_view text, std::string_view origin) {
    const std::optional<Parts> number = partsOf(text);
    const std::optional<Parts> start = partsOf(origin);
    if (!number || !start) {
        return std::nullopt;
    }
    return (number->whole - start->whole) + (number->fraction - start->fraction);
}

std::string fixedDecimals(double value, int digits) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    const double unit = std::pow(10.0, -digits);
    stream << std::fixed << std::setprecision(digits) << std::round(value / unit) * unit + 0.0;
    return stream.str();
}

}  // namespace haptoflow::cli
