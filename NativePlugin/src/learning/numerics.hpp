#pragma once

#include "learning/texture_figures.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// A small dense symmetric matrix, row by row. Home-made: these two algorithms are all that learning needs, and their
/// fixed order of operations gives equal bytes on all platforms.
struct SymmetricMatrix {
    explicit SymmetricMatrix(std::size_t order) : size(order), values(order * order) {}

    [[nodiscard]] double& at(std::size_t row, std::size_t column) { return values[row * size + column]; }
    [[nodiscard]] double at(std::size_t row, std::size_t column) const { return values[row * size + column]; }

    std::size_t size;
    std::vector<double> values;
};

/// Eigenvalues in decreasing order and the unit eigenvector of each, row by row. The largest component of each vector
/// is positive, so that equal matrices give equal bytes.
struct EigenDecomposition {
    std::vector<double> values;
    std::vector<std::vector<double>> vectors;
};

/// By Jacobi rotations.
[[nodiscard]] EigenDecomposition decompose(SymmetricMatrix matrix);

/// The Cholesky decomposition of a positive definite matrix; of one that is not, with a small ridge.
class PositiveFactor {
public:
    explicit PositiveFactor(const SymmetricMatrix& matrix);

    /// Solves matrix x = right.
    [[nodiscard]] std::vector<double> solve(std::vector<double> right) const;

private:
    SymmetricMatrix factor_;
};

/// Solves matrix x = right once.
[[nodiscard]] std::vector<double> solvePositive(const SymmetricMatrix& matrix, std::vector<double> right);

/// CMA-ES (Hansen and Ostermeier 2001; parameters of Hansen's tutorial, 2016): minimises without gradients. Call `ask`
/// for a generation and `tell` with its scores. Equal seeds and scores give equal generations on every machine with
/// IEEE 754 arithmetic. Home-made: libcmaes needs Eigen and does not guarantee equal results on all platforms.
class EvolutionStrategy {
public:
    /// One coordinate and a population of 4 at least.
    EvolutionStrategy(std::vector<double> start, double stepSize, std::size_t population, std::uint64_t seed);

    /// The points of the next generation, each with the start's number of coordinates.
    [[nodiscard]] const std::vector<std::vector<double>>& ask();
    /// Scores of the points of `ask`, in their order; lower is better.
    void tell(std::span<const double> scores);

    /// Centre of the distribution: for noisy scores a better estimate than the best point.
    [[nodiscard]] const std::vector<double>& mean() const noexcept { return mean_; }

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

/// Smooth functions of speed and force over what a recording holds. Inside, the logarithms are scaled to a standard
/// deviation of 1; beyond the third and the 97th percentile of the frames, every function is constant.
class ConditionBasis {
public:
    /// `frames` is not empty.
    explicit ConditionBasis(std::span<const SpectrumFrame> frames);

    /// Number of functions: 1, speed, force and Gaussians.
    [[nodiscard]] std::size_t count() const noexcept { return 3 + speedCentres_.size() * forceCentres_.size(); }
    /// Functions from this one on are Gaussians.
    static constexpr std::size_t firstGaussian = 3;
    [[nodiscard]] std::vector<double> at(double speedMps, double newtons) const;

    static constexpr std::size_t cubicCount = 10;
    /// 1, speed, force and their products of second and third degree.
    [[nodiscard]] std::array<double, cubicCount> cubicAt(double speedMps, double newtons) const;

    /// Speeds and forces, evenly distributed over the logarithm, from one end of the range to the other. One force
    /// if it hardly changes.
    [[nodiscard]] std::vector<double> speedsMps(std::size_t count) const { return speed_.evenly(count); }
    [[nodiscard]] std::vector<double> forcesNewtons(std::size_t count) const { return force_.evenly(count); }

private:
    struct Scale {
        explicit Scale(std::vector<double> values);

        double mean = 0.0;
        double deviation = 1.0;
        double lowest = 0.0;
        double highest = 0.0;

        /// False if the values hardly differ: the scaled value is then 0.
        [[nodiscard]] bool varies() const noexcept;
        [[nodiscard]] double scaled(double value) const;
        /// Scaled values at even distances.
        [[nodiscard]] std::vector<double> centres(std::size_t count) const;
        [[nodiscard]] std::vector<double> evenly(std::size_t count) const;
    };

    Scale speed_;
    Scale force_;
    std::vector<double> speedCentres_;
    std::vector<double> forceCentres_;
};

/// Fits log E[value] = row . coefficients to positive values with a Gamma distribution (McCullagh and Nelder,
/// "Generalized linear models", 8.3), by Fisher scoring with a normal prior of mean 0 for each coefficient.
///
/// Shapes: `values` [n], `rows` [n][p] one row after the other, `deviations` [p] of the prior. `weight`: of one value,
/// one over the square of its coefficient of variation. Unlike least squares of the logarithms, it keeps the mean of
/// the values.
[[nodiscard]] std::vector<double> gammaRegression(std::span<const double> values, std::span<const double> rows,
                                                  std::span<const double> deviations, double weight);

/// Largest change of a logarithm in one round; a larger step is shortened, because the first ones overshoot.
inline constexpr double largestLogStep = 1.0;

}  // namespace haptoflow::learning
