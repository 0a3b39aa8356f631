#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptoflow::cli {

/// The difference of two decimals, such as seconds since 1970, with the digits that their own rounding to a double
/// would lose. Empty if one of them is no number.
[[nodiscard]] std::optional<double> decimalDifference(std::string_view text, std::string_view origin);

/// The number with a fixed count of digits after the decimal point, in every locale; never "-0".
[[nodiscard]] std::string fixedDecimals(double value, int digits);

/// A length or a speed in metres as whole millimetres, without the unit.
[[nodiscard]] std::string inMillimetres(double metres);

}  // namespace haptoflow::cli
