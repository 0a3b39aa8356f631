#include "decimal_text.hpp"

#include "recordings/table_rows.hpp"

#include <cmath>
#include <iomanip>
#include <locale>
#include <sstream>

namespace haptoflow::cli {
namespace {

struct Parts {
    double whole = 0.0;
    double fraction = 0.0;
};

/// A decimal before and after its point; a number with an exponent is its whole part.
std::optional<Parts> partsOf(std::string_view text) {
    const std::optional<double> value = recordings::decimalNumber(text);
    const std::size_t point = text.find('.');
    if (!value || point == std::string_view::npos || text.find_first_of("eE") != std::string_view::npos) {
        return value ? std::optional(Parts{.whole = *value}) : std::nullopt;
    }
    // Not the truncated value, which may have been rounded up.
    const std::optional<double> whole = recordings::decimalNumber(text.substr(0, point));
    const std::optional<double> fraction = recordings::decimalNumber(std::string("0").append(text.substr(point)));
    return Parts{.whole = whole.value_or(0.0), .fraction = std::copysign(fraction.value_or(0.0), *value)};
}

}  // namespace

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

std::string inMillimetres(double metres) {
    return fixedDecimals(1000.0 * metres, 0);
}

}  // namespace haptoflow::cli
