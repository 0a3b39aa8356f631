#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptoflow::cli {

/// The number that the whole text represents, with a decimal point in every locale and an optional plus sign. Empty for
/// any other text, and for numbers too large or too small to represent.
[[nodiscard]] std::optional<double> decimalNumber(std::string_view text);

/// The number with a fixed count of digits after the decimal point, in every locale; never "-0".
[[nodiscard]] std::string fixedDecimals(double value, int digits);

}  // namespace haptoflow::cli
