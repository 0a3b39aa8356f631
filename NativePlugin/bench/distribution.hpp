#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <vector>

namespace haptoflow::bench {

/// Percentiles of repeated measurements. A mean would hide the slow ones, which are the perceptible ones.
struct Distribution {
    std::size_t count = 0;
    double p50 = 0.0;
    double p99 = 0.0;
    double worst = 0.0;
};

/// Scales of `toJson` for values in seconds.
inline constexpr double milliseconds = 1e3;
inline constexpr double microseconds = 1e6;

/// By nearest rank: p50 and p99 are measured values, and below 100 values p99 is the worst one.
/// Throws std::invalid_argument if there are no values.
[[nodiscard]] Distribution distributionOf(std::vector<double> values);

/// The number rounded to six significant digits; further digits of a time are noise.
[[nodiscard]] double rounded(double value);

/// {"count", "p50", "p99", "worst"}, each multiplied by `scale` and rounded.
[[nodiscard]] nlohmann::ordered_json toJson(const Distribution& distribution, double scale = 1.0);

/// numerator / denominator, both rounded as they are printed; null if the denominator is 0.
[[nodiscard]] nlohmann::ordered_json ratioOf(double numerator, double denominator);

}  // namespace haptoflow::bench
