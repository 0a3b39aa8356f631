#pragma once

#include "learning/closed_loop.hpp"
#include "learning/sliding.hpp"
#include "skeleton/skeleton.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// How probable the recording is for the skeleton's filter of an embedding: the Gaussian likelihood of one-step
/// prediction errors, by which the filter is trained (Training/haptoflow_training/models/skeleton.py). Of the recording
/// it keeps one covariance for each cell of speed, force and direction, so that an embedding costs milliseconds.
class FilterLikelihood {
public:
    /// `unitWave`: the recording divided by its level. `skeleton` must outlive the likelihood.
    FilterLikelihood(const skeleton::Skeleton& skeleton, const recordings::PreparedRecording& recording,
                     const Sliding& sliding, std::span<const float> unitWave);

    /// Negative log-likelihood per sample in nats.
    [[nodiscard]] double loss(const Embedding& embedding) const;
    /// Number of samples whose prediction counts.
    [[nodiscard]] double samples() const noexcept { return samples_; }

private:
    static constexpr std::size_t size = skeleton::filterOrder + 1;
    /// Sums over the samples x[n] of one cell.
    struct Cell {
        double samples = 0.0;
        std::array<double, 3> motion{};
        /// Of x[n - i] x[n - j].
        std::array<std::array<double, size>, size> products{};
    };
    void add(Cell& cell, std::span<const float> wave, const std::array<double, 3>& motion) const;

    const skeleton::Skeleton& skeleton_;
    std::vector<Cell> cells_;
    double samples_ = 0.0;
};

}  // namespace haptoflow::learning
