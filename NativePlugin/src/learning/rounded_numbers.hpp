#pragma once

#include <nlohmann/json.hpp>

#include <cmath>

namespace haptoflow::learning {

/// Rounds to the significant digits, which makes files smaller and equal on platforms whose last bits differ.
inline double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit + 0.0;
}

template <typename Range>
nlohmann::ordered_json roundedNumbers(const Range& values, double perUnit) {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const auto value : values) {
        result.push_back(rounded(static_cast<double>(value), perUnit));
    }
    return result;
}

}  // namespace haptoflow::learning
