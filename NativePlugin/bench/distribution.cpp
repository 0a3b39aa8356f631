#include "bench/distribution.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace haptoflow::bench {
namespace {

double nearestRank(const std::vector<double>& sorted, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(sorted.size())));
    return sorted[std::max<std::size_t>(rank, 1) - 1];
}

}  // namespace

Distribution distributionOf(std::vector<double> values) {
    if (values.empty()) {
        throw std::invalid_argument("a distribution needs at least one value");
    }
    std::ranges::sort(values);
    return {.count = values.size(),
            .p50 = nearestRank(values, 0.5),
            .p99 = nearestRank(values, 0.99),
            .worst = values.back()};
}

double rounded(double value) {
    if (value == 0.0 || !std::isfinite(value)) {
        return value;
    }
    constexpr int digits = 6;
    const int shift = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
    const double power = std::pow(10.0, std::abs(shift));
    return shift >= 0 ? std::round(value * power) / power : std::round(value / power) * power;
}

nlohmann::ordered_json toJson(const Distribution& distribution, double scale) {
    return {{"count", distribution.count},
            {"p50", rounded(distribution.p50 * scale)},
            {"p99", rounded(distribution.p99 * scale)},
            {"worst", rounded(distribution.worst * scale)}};
}

nlohmann::ordered_json ratioOf(double numerator, double denominator) {
    if (denominator == 0.0) {
        return nullptr;
    }
    return rounded(numerator / denominator);
}

}  // namespace haptoflow::bench
