#pragma once

#include "learning/embedding_space.hpp"
#include "learning/filter_likelihood.hpp"
#include "learning/texture_fit.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace haptoflow::learning {

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

}  // namespace haptoflow::learning
