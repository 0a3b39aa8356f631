#pragma once

#include "learning/closed_loop.hpp"
#include "model/model_file.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// Embeddings in coordinates along the principal axes of the model's labels, in units of the labels' standard deviation
/// along each axis. Wave vectors are not among the coordinates: they are given.
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

}  // namespace haptoflow::learning
