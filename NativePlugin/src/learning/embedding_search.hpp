#pragma once

#include "learning/closed_loop.hpp"
#include "learning/sliding.hpp"
#include "learning/texture_figures.hpp"
#include "learning/texture_fit.hpp"
#include "model/model_file.hpp"
#include "model/model_header.hpp"
#include "skeleton/skeleton.hpp"

#include <array>
#include <cstdint>
#include <functional>
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

/// Embeddings in coordinates along the principal axes of the model's labels, in units of the labels' standard deviation
/// along each axis. Wave vectors are no coordinates: every embedding of this space has those that it was made with.
class EmbeddingSpace {
public:
    static constexpr std::size_t maximumAxes = 16;

    EmbeddingSpace(const model::ModelFile& model, std::span<const float, 2 * inference::ribCount> waveVectors);

    [[nodiscard]] std::size_t axisCount() const noexcept { return axes_.size(); }
    [[nodiscard]] std::vector<double> coordinatesOf(const Embedding& embedding) const;
    /// The embedding at these coordinates. The part of `base` that the axes do not cover is kept, so that a label's own
    /// coordinates give its embedding.
    [[nodiscard]] Embedding at(const Embedding& base, std::span<const double> coordinates) const;
    /// The label's embedding with the given wave vectors.
    [[nodiscard]] Embedding ofLabel(std::size_t label) const;

private:
    const model::ModelFile& model_;
    std::array<float, 2 * inference::ribCount> waveVectors_{};
    std::vector<double> mean_;
    std::vector<std::vector<double>> axes_;
    std::vector<double> spreads_;
};

struct SearchSettings {
    std::uint64_t seed = 1;
    /// Maximum number of segments to generate.
    std::uint64_t segmentBudget = 0;
    /// True for ruled materials: only embeddings of labels with ribs respond to wave vectors.
    bool needsRibs = false;
    /// Receives the completed share, 0 to 1.
    std::function<void(double)> progress;
    /// True ends the search with its best result.
    std::function<bool()> isOver;
};

/// The index of the label whose render along the recording's own motion is nearest to it.
[[nodiscard]] std::size_t startLabel(TextureFit& fit, const EmbeddingSpace& space,
                                     const std::vector<model::Label>& labels, const SearchSettings& settings);

struct FittedEmbedding {
    Embedding embedding{};
    /// Distance between the closed loop and the recording in dB, at the start and of the result; see textureDistance.
    double startDistanceDb = 0.0;
    double distanceDb = 0.0;
    std::uint64_t generations = 0;
};

/// Searches the space of the model's labels with CMA-ES from `start`, which stays if nothing better is found.
[[nodiscard]] FittedEmbedding fitEmbedding(TextureFit& fit, const EmbeddingSpace& space, const Embedding& start,
                                           const SearchSettings& settings);

/// The index of the label whose filter makes the recording the most probable.
[[nodiscard]] std::size_t likeliestLabel(const FilterLikelihood& likelihood, const EmbeddingSpace& space,
                                         std::size_t labels);

/// Searches the space of the model's labels, in which labels are normally distributed, with CMA-ES for the embedding
/// whose filter makes the recording the most probable. For recordings without ribs, which a filter cannot explain.
[[nodiscard]] FittedEmbedding likeliestEmbedding(const FilterLikelihood& likelihood, TextureFit& fit,
                                                 const EmbeddingSpace& space, const Embedding& start,
                                                 const SearchSettings& settings);

/// The power of the speed with which the spectrum's centre rises on a surface without ribs, 0 to 1: the slope of the
/// centre's log frequency over the log speed, drawn towards the start label's value where speeds are few.
[[nodiscard]] double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                                       const model::Label& start);

/// The factor on an embedding's impulses, 0 to 4, with which the kurtosis of its closed loop is nearest to the
/// recording's. Few labels have impulses, so that an embedding alone says little of them. For a recording without ribs:
/// ribs change the kurtosis too. `progress` receives the completed share, 0 to 1.
[[nodiscard]] float fitImpulseGain(TextureFit& fit, const Embedding& embedding,
                                   const std::function<void(double)>& progress);

}  // namespace haptoflow::learning
