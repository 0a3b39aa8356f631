#include "learning/numerics.hpp"

#include "recordings/recording.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace haptoflow::learning {
namespace {

constexpr int maximumSweeps = 60;

double offDiagonal(const SymmetricMatrix& matrix) {
    double sum = 0.0;
    for (std::size_t i = 0; i < matrix.size; ++i) {
        for (std::size_t j = i + 1; j < matrix.size; ++j) {
            sum += matrix.at(i, j) * matrix.at(i, j);
        }
    }
    return sum;
}

void rotate(SymmetricMatrix& matrix, SymmetricMatrix& vectors, std::size_t p, std::size_t q) {
    const double element = matrix.at(p, q);
    if (element == 0.0) {
        return;
    }
    const double theta = (matrix.at(q, q) - matrix.at(p, p)) / (2.0 * element);
    const double tangent = (theta >= 0.0 ? 1.0 : -1.0) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
    const double cosine = 1.0 / std::sqrt(tangent * tangent + 1.0);
    const double sine = tangent * cosine;
    for (std::size_t i = 0; i < matrix.size; ++i) {
        const double one = matrix.at(i, p);
        const double other = matrix.at(i, q);
        matrix.at(i, p) = cosine * one - sine * other;
        matrix.at(i, q) = sine * one + cosine * other;
    }
    for (std::size_t i = 0; i < matrix.size; ++i) {
        const double one = matrix.at(p, i);
        const double other = matrix.at(q, i);
        matrix.at(p, i) = cosine * one - sine * other;
        matrix.at(q, i) = sine * one + cosine * other;
        const double first = vectors.at(p, i);
        const double second = vectors.at(q, i);
        vectors.at(p, i) = cosine * first - sine * second;
        vectors.at(q, i) = sine * first + cosine * second;
    }
}

bool factorise(SymmetricMatrix& matrix) {
    for (std::size_t j = 0; j < matrix.size; ++j) {
        for (std::size_t i = j; i < matrix.size; ++i) {
            double sum = matrix.at(i, j);
            for (std::size_t k = 0; k < j; ++k) {
                sum -= matrix.at(i, k) * matrix.at(j, k);
            }
            if (i == j) {
                if (!(sum > 0.0)) {
                    return false;
                }
                matrix.at(j, j) = std::sqrt(sum);
            } else {
                matrix.at(i, j) = sum / matrix.at(j, j);
            }
        }
    }
    return true;
}

}  // namespace

EigenDecomposition decompose(SymmetricMatrix matrix) {
    const std::size_t size = matrix.size;
    SymmetricMatrix vectors(size);
    double scale = 0.0;
    for (std::size_t i = 0; i < size; ++i) {
        vectors.at(i, i) = 1.0;
        scale += matrix.at(i, i) * matrix.at(i, i);
    }
    for (int sweep = 0; sweep < maximumSweeps && offDiagonal(matrix) > 1e-24 * scale; ++sweep) {
        for (std::size_t p = 0; p < size; ++p) {
            for (std::size_t q = p + 1; q < size; ++q) {
                rotate(matrix, vectors, p, q);
            }
        }
    }
    std::vector<std::size_t> order(size);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t each) { return std::pair(-matrix.at(each, each), each); });
    EigenDecomposition result;
    for (const std::size_t row : order) {
        result.values.push_back(matrix.at(row, row));
        std::vector<double> vector(vectors.values.begin() + static_cast<std::ptrdiff_t>(row * size),
                                   vectors.values.begin() + static_cast<std::ptrdiff_t>((row + 1) * size));
        const auto largest =
            std::ranges::max_element(vector, [](double a, double b) { return std::abs(a) < std::abs(b); });
        if (largest != vector.end() && *largest < 0.0) {
            std::ranges::transform(vector, vector.begin(), [](double value) { return -value; });
        }
        result.vectors.push_back(std::move(vector));
    }
    return result;
}

PositiveFactor::PositiveFactor(const SymmetricMatrix& matrix) : factor_(matrix) {
    constexpr int maximumTries = 12;
    double ridge = 1e-12;
    for (int attempt = 0; attempt < maximumTries && !factorise(factor_); ++attempt) {
        factor_ = matrix;
        for (std::size_t i = 0; i < matrix.size; ++i) {
            factor_.at(i, i) += ridge * (1.0 + std::abs(matrix.at(i, i)));
        }
        ridge *= 10.0;
    }
}

std::vector<double> PositiveFactor::solve(std::vector<double> right) const {
    for (std::size_t i = 0; i < factor_.size; ++i) {
        for (std::size_t k = 0; k < i; ++k) {
            right[i] -= factor_.at(i, k) * right[k];
        }
        right[i] /= factor_.at(i, i);
    }
    for (std::size_t i = factor_.size; i-- > 0;) {
        for (std::size_t k = i + 1; k < factor_.size; ++k) {
            right[i] -= factor_.at(k, i) * right[k];
        }
        right[i] /= factor_.at(i, i);
    }
    return right;
}

std::vector<double> solvePositive(const SymmetricMatrix& matrix, std::vector<double> right) {
    return PositiveFactor(matrix).solve(std::move(right));
}

EvolutionStrategy::EvolutionStrategy(std::vector<double> start, double stepSize, std::size_t population,
                                     std::uint64_t seed)
    : size_(start.size()),
      population_(population),
      seed_(seed),
      mean_(std::move(start)),
      stepSize_(stepSize),
      covariance_(size_),
      stepPath_(size_),
      path_(size_) {
    const std::size_t parents = population / 2;
    const auto n = static_cast<double>(size_);
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < parents; ++i) {
        weights_.push_back(std::log(0.5 * static_cast<double>(population) + 0.5) -
                           std::log(static_cast<double>(i + 1)));
        sum += weights_.back();
    }
    for (double& weight : weights_) {
        weight /= sum;
        squares += weight * weight;
    }
    effective_ = 1.0 / squares;
    stepPathRate_ = (effective_ + 2.0) / (n + effective_ + 5.0);
    damping_ = 1.0 + 2.0 * std::max(0.0, std::sqrt((effective_ - 1.0) / (n + 1.0)) - 1.0) + stepPathRate_;
    pathRate_ = (4.0 + effective_ / n) / (n + 4.0 + 2.0 * effective_ / n);
    rankOneRate_ = 2.0 / ((n + 1.3) * (n + 1.3) + effective_);
    rankMuRate_ = std::min(1.0 - rankOneRate_,
                           2.0 * (effective_ - 2.0 + 1.0 / effective_) / ((n + 2.0) * (n + 2.0) + effective_));
    expectedLength_ = std::sqrt(n) * (1.0 - 1.0 / (4.0 * n) + 1.0 / (21.0 * n * n));
    for (std::size_t i = 0; i < size_; ++i) {
        covariance_.at(i, i) = 1.0;
    }
    decomposeCovariance();
}

void EvolutionStrategy::decomposeCovariance() {
    axes_ = decompose(covariance_);
    for (double& value : axes_.values) {
        value = std::sqrt(std::max(value, 1e-20));
    }
}

const std::vector<std::vector<double>>& EvolutionStrategy::ask() {
    points_.assign(population_, mean_);
    std::vector<float> normal(size_);
    for (std::size_t k = 0; k < population_; ++k) {
        skeleton::fillStandardNormal({.seed = seed_, .voice = static_cast<std::uint32_t>(k), .segment = generation_},
                                     normal);
        for (std::size_t axis = 0; axis < size_; ++axis) {
            const double along = stepSize_ * axes_.values[axis] * static_cast<double>(normal[axis]);
            for (std::size_t i = 0; i < size_; ++i) {
                points_[k][i] += along * axes_.vectors[axis][i];
            }
        }
    }
    ++generation_;
    return points_;
}

void EvolutionStrategy::tell(std::span<const double> scores) {
    std::vector<std::size_t> order(population_);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t each) { return std::pair(scores[each], each); });

    std::vector<double> step(size_);
    for (std::size_t rank = 0; rank < weights_.size(); ++rank) {
        for (std::size_t i = 0; i < size_; ++i) {
            step[i] += weights_[rank] * (points_[order[rank]][i] - mean_[i]) / stepSize_;
        }
    }
    // C^(-1/2) step, along the axes.
    std::vector<double> whitened(size_);
    for (std::size_t axis = 0; axis < size_; ++axis) {
        const double along =
            std::inner_product(step.begin(), step.end(), axes_.vectors[axis].begin(), 0.0) / axes_.values[axis];
        for (std::size_t i = 0; i < size_; ++i) {
            whitened[i] += along * axes_.vectors[axis][i];
        }
    }
    const double stepPathGain = std::sqrt(stepPathRate_ * (2.0 - stepPathRate_) * effective_);
    double length = 0.0;
    for (std::size_t i = 0; i < size_; ++i) {
        stepPath_[i] = (1.0 - stepPathRate_) * stepPath_[i] + stepPathGain * whitened[i];
        length += stepPath_[i] * stepPath_[i];
    }
    length = std::sqrt(length);
    const double settled = std::sqrt(1.0 - std::pow(1.0 - stepPathRate_, 2.0 * static_cast<double>(generation_)));
    const bool isSteady = length / settled / expectedLength_ < 1.4 + 2.0 / (static_cast<double>(size_) + 1.0);
    const double pathGain = isSteady ? std::sqrt(pathRate_ * (2.0 - pathRate_) * effective_) : 0.0;
    for (std::size_t i = 0; i < size_; ++i) {
        path_[i] = (1.0 - pathRate_) * path_[i] + pathGain * step[i];
    }
    const double kept =
        1.0 - rankOneRate_ - rankMuRate_ + (isSteady ? 0.0 : rankOneRate_ * pathRate_ * (2.0 - pathRate_));
    for (std::size_t i = 0; i < size_; ++i) {
        for (std::size_t j = 0; j < size_; ++j) {
            double value = kept * covariance_.at(i, j) + rankOneRate_ * path_[i] * path_[j];
            for (std::size_t rank = 0; rank < weights_.size(); ++rank) {
                const std::vector<double>& point = points_[order[rank]];
                value += rankMuRate_ * weights_[rank] * (point[i] - mean_[i]) * (point[j] - mean_[j]) /
                         (stepSize_ * stepSize_);
            }
            covariance_.at(i, j) = value;
        }
    }
    for (std::size_t i = 0; i < size_; ++i) {
        mean_[i] += stepSize_ * step[i];
    }
    stepSize_ *= std::exp(std::min(1.0, stepPathRate_ / damping_ * (length / expectedLength_ - 1.0)));
    decomposeCovariance();
}

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
