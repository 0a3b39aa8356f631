#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptoflow::cli {

/// The whole text as a decimal number with a point, whatever the locale; one plus sign may stand before it. Nothing
/// for any other text, and for a number too large or too small to represent.
[[nodiscard]] std::optional<double> decimalNumber(std::string_view text);

/// With so many digits after the point, whatever the locale; never "-0".
[[nodiscard]] std::string fixedDecimals(double value, int digits);

}  // namespace haptoflow::cli
