#pragma once

#include <string>

namespace haptoflow::learning {

/// Three significant digits with a decimal point, in every locale: "0.0823", "12.5", "1200".
[[nodiscard]] std::string plainNumber(double value);

}  // namespace haptoflow::learning
