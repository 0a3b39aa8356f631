#include "learning/evolution_strategy.hpp"

#include "inference/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace haptoflow::learning {

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
    if (size_ == 0 || population < 4) {
        throw std::invalid_argument("an evolution strategy needs one coordinate and a population of 4 at least");
    }
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
        inference::fillStandardNormal({.seed = seed_, .voice = static_cast<std::uint32_t>(k), .segment = generation_},
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

}  // namespace haptoflow::learning
