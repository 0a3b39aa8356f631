#pragma once

#include "learning/closed_loop.hpp"
#include "model/model_file.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// Embeddings by their coordinates along the principal axes of the model's labels, in units of the labels' spread along
/// each. Wave vectors stand apart: they are given.
class EmbeddingSpace {
public:
    static constexpr std::size_t mostAxes = 16;

    EmbeddingSpace(const model::ModelFile& model, std::span<const float, 2 * inference::ribCount> waveVectors);

    [[nodiscard]] std::size_t axisCount() const noexcept { return axes_.size(); }
    [[nodiscard]] std::vector<double> coordinatesOf(const Embedding& embedding) const;
    /// What the axes leave of `base` stays, so that a label's own coordinates give the label.
    [[nodiscard]] Embedding at(const Embedding& base, std::span<const double> coordinates) const;
    /// The label's embedding with the wave vectors that were given.
    [[nodiscard]] Embedding ofLabel(std::size_t label) const;

private:
    const model::ModelFile& model_;
    std::array<float, 2 * inference::ribCount> waveVectors_{};
    std::vector<double> mean_;
    std::vector<std::vector<double>> axes_;
    std::vector<double> spreads_;
};

}  // namespace haptoflow::learning
