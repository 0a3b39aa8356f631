#include "learning/gamma_regression.hpp"

#include "learning/numerics.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptoflow::learning {
namespace {

constexpr std::size_t speedGaussians = 5;
constexpr std::size_t forceGaussians = 4;
constexpr double gaussianWidth = 0.8;
constexpr double smallestValue = 1e-4;
/// As a ratio: forces within a tenth of each other count as one.
constexpr double narrowestRange = 0.1;

template <typename Member>
std::vector<double> valuesOf(std::span<const SpectrumFrame> frames, Member member) {
    std::vector<double> values(frames.size());
    std::ranges::transform(frames, values.begin(), member);
    return values;
}

std::vector<double> between(double first, double last, std::size_t count) {
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i) {
        values[i] = std::lerp(first, last, static_cast<double>(i) / static_cast<double>(count - 1));
    }
    return values;
}

}  // namespace

ConditionBasis::Scale::Scale(std::vector<double> values) {
    for (double& value : values) {
        value = std::log(std::max(value, smallestValue));
        mean += value / static_cast<double>(values.size());
    }
    double variance = 0.0;
    for (const double value : values) {
        variance += (value - mean) * (value - mean) / static_cast<double>(values.size());
    }
    deviation = std::sqrt(variance);
    lowest = recordings::quantile(values, 0.03);
    highest = recordings::quantile(values, 0.97);
}

bool ConditionBasis::Scale::varies() const noexcept {
    return highest - lowest > narrowestRange && deviation > 0.0;
}

double ConditionBasis::Scale::scaled(double value) const {
    if (!varies()) {
        return 0.0;
    }
    return (std::clamp(std::log(std::max(value, smallestValue)), lowest, highest) - mean) / deviation;
}

std::vector<double> ConditionBasis::Scale::centres(std::size_t count) const {
    return varies() ? between((lowest - mean) / deviation, (highest - mean) / deviation, count)
                    : std::vector<double>{0.0};
}

std::vector<double> ConditionBasis::Scale::evenly(std::size_t count) const {
    if (!varies()) {
        return {std::exp(mean)};
    }
    std::vector<double> values = between(lowest, highest, count);
    std::ranges::transform(values, values.begin(), [](double value) { return std::exp(value); });
    return values;
}

ConditionBasis::ConditionBasis(std::span<const SpectrumFrame> frames)
    : speed_(valuesOf(frames, &SpectrumFrame::speedMps)),
      force_(valuesOf(frames, &SpectrumFrame::forceNewtons)),
      speedCentres_(speed_.centres(speedGaussians)),
      forceCentres_(force_.centres(forceGaussians)) {}

std::vector<double> ConditionBasis::at(double speedMps, double newtons) const {
    const double x = speed_.scaled(speedMps);
    const double y = force_.scaled(newtons);
    std::vector<double> values{1.0, x, y};
    for (const double centreX : speedCentres_) {
        for (const double centreY : forceCentres_) {
            const double distance = std::hypot(x - centreX, y - centreY) / gaussianWidth;
            values.push_back(std::exp(-0.5 * distance * distance));
        }
    }
    return values;
}

std::array<double, ConditionBasis::cubicCount> ConditionBasis::cubicAt(double speedMps, double newtons) const {
    const double x = speed_.scaled(speedMps);
    const double y = force_.scaled(newtons);
    return {1.0, x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y};
}

namespace {

constexpr int rounds = 20;
constexpr double settled = 1e-4;

double product(std::span<const double> left, std::span<const double> right) {
    return std::inner_product(left.begin(), left.end(), right.begin(), 0.0);
}

}  // namespace

std::vector<double> gammaRegression(std::span<const double> values, std::span<const double> rows,
                                    std::span<const double> deviations, double weight) {
    const std::size_t count = deviations.size();
    SymmetricMatrix information(count);
    const auto rowOf = [&](std::size_t index) { return rows.subspan(index * count, count); };
    for (std::size_t index = 0; index < values.size(); ++index) {
        const auto row = rowOf(index);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t j = 0; j < count; ++j) {
                information.at(i, j) += weight * row[i] * row[j];
            }
        }
    }
    for (std::size_t i = 0; i < count; ++i) {
        information.at(i, i) += 1.0 / (deviations[i] * deviations[i]);
    }
    const PositiveFactor factor(information);
    std::vector<double> found(count);
    for (int round = 0; round < rounds; ++round) {
        std::vector<double> score(count);
        for (std::size_t i = 0; i < count; ++i) {
            score[i] = -found[i] / (deviations[i] * deviations[i]);
        }
        for (std::size_t index = 0; index < values.size(); ++index) {
            const auto row = rowOf(index);
            const double excess = values[index] * std::exp(-product(row, found)) - 1.0;
            for (std::size_t i = 0; i < count; ++i) {
                score[i] += weight * row[i] * excess;
            }
        }
        const std::vector<double> change = factor.solve(std::move(score));
        double largest = 0.0;
        for (std::size_t index = 0; index < values.size(); ++index) {
            largest = std::max(largest, std::abs(product(rowOf(index), change)));
        }
        const double share = largest > largestLogStep ? largestLogStep / largest : 1.0;
        for (std::size_t i = 0; i < count; ++i) {
            found[i] += share * change[i];
        }
        if (largest < settled) {
            break;
        }
    }
    return found;
}

}  // namespace haptoflow::learning
