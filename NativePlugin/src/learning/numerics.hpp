#pragma once

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

}  // namespace haptoflow::learning
