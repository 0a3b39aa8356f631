#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace haptoflow::recordings {

/// The number that the whole text represents, with a decimal point in every locale and an optional plus sign. The minus
/// may be U+2212, as some languages write it. Empty for any other text, and for numbers too large or too small to
/// represent.
[[nodiscard]] std::optional<double> decimalNumber(std::string_view text);

}  // namespace haptoflow::recordings
