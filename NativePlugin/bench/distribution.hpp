#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace haptoflow::bench {

/// What is told of many measurements of one thing. A mean would hide the ones that are felt.
struct Distribution {
    std::size_t count = 0;
    double p50 = 0.0;
    double p99 = 0.0;
    double worst = 0.0;
};

/// What `toJson` multiplies seconds by.
inline constexpr double milliseconds = 1e3;
inline constexpr double microseconds = 1e6;

/// By nearest rank: p50 and p99 are values that were measured, and below 100 values p99 is the worst.
/// Throws std::invalid_argument for no value.
[[nodiscard]] Distribution distributionOf(std::vector<double> values);

/// The number to six significant digits: more of a time is noise.
[[nodiscard]] double rounded(double value);

/// {"count", "p50", "p99", "worst"}, each times `scale`, rounded.
[[nodiscard]] nlohmann::ordered_json toJson(const Distribution& distribution, double scale = 1.0);

/// numerator / denominator of figures as they are printed, rounded; null where the denominator is 0.
[[nodiscard]] nlohmann::ordered_json ratioOf(double numerator, double denominator);

}  // namespace haptoflow::bench
