#pragma once

#include "learning/linear_algebra.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// CMA-ES (Hansen and Ostermeier 2001; parameters of Hansen's tutorial, 2016): minimises without gradients. Ask for a
/// generation, measure it, tell the scores. Equal seeds and scores give equal generations on every machine whose
/// arithmetic is IEEE 754's.
class EvolutionStrategy {
public:
    EvolutionStrategy(std::vector<double> start, double stepSize, std::size_t population, std::uint64_t seed);

    /// Points of the next generation, each with the start's number of coordinates.
    [[nodiscard]] const std::vector<std::vector<double>>& ask();
    /// Scores of the points that `ask` gave, in their order; less is better.
    void tell(std::span<const double> scores);

    /// Where the distribution's centre is: with noisy scores a better guess than the best point.
    [[nodiscard]] const std::vector<double>& mean() const noexcept { return mean_; }
    [[nodiscard]] double stepSize() const noexcept { return stepSize_; }

private:
    void decomposeCovariance();

    std::size_t size_;
    std::size_t population_;
    std::uint64_t seed_;
    std::uint64_t generation_ = 0;
    std::vector<double> mean_;
    double stepSize_;
    std::vector<double> weights_;
    double effective_ = 0.0;
    double stepPathRate_ = 0.0;
    double damping_ = 0.0;
    double pathRate_ = 0.0;
    double rankOneRate_ = 0.0;
    double rankMuRate_ = 0.0;
    double expectedLength_ = 0.0;
    SymmetricMatrix covariance_;
    EigenDecomposition axes_;
    std::vector<double> stepPath_;
    std::vector<double> path_;
    std::vector<std::vector<double>> points_;
};

}  // namespace haptoflow::learning
