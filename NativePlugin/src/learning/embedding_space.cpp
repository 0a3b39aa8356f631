#include "learning/embedding_space.hpp"

#include "learning/linear_algebra.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

constexpr std::size_t freeNumbers = inference::embeddingSize - 2 * inference::ribCount;

}  // namespace

EmbeddingSpace::EmbeddingSpace(const model::ModelFile& model,
                               std::span<const float, 2 * inference::ribCount> waveVectors)
    : model_(model), mean_(freeNumbers) {
    std::ranges::copy(waveVectors, waveVectors_.begin());
    const std::size_t labels = model.header().labels.size();
    const auto count = static_cast<double>(labels);
    for (std::size_t label = 0; label < labels; ++label) {
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            mean_[i] += model.embedding(label)[i] / count;
        }
    }
    SymmetricMatrix covariance(freeNumbers);
    for (std::size_t label = 0; label < labels; ++label) {
        const auto row = model.embedding(label);
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            for (std::size_t j = 0; j < freeNumbers; ++j) {
                covariance.at(i, j) += (row[i] - mean_[i]) * (row[j] - mean_[j]) / count;
            }
        }
    }
    EigenDecomposition axes = decompose(std::move(covariance));
    for (std::size_t axis = 0; axis < std::min({maximumAxes, labels - std::min<std::size_t>(labels, 1), freeNumbers});
         ++axis) {
        if (axes.values[axis] <= 1e-6 * axes.values[0]) {
            break;
        }
        spreads_.push_back(std::sqrt(axes.values[axis]));
        axes_.push_back(std::move(axes.vectors[axis]));
    }
}

std::vector<double> EmbeddingSpace::coordinatesOf(const Embedding& embedding) const {
    std::vector<double> coordinates(axes_.size());
    for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
        for (std::size_t i = 0; i < freeNumbers; ++i) {
            coordinates[axis] += (embedding[i] - mean_[i]) * axes_[axis][i] / spreads_[axis];
        }
    }
    return coordinates;
}

Embedding EmbeddingSpace::at(const Embedding& base, std::span<const double> coordinates) const {
    const std::vector<double> own = coordinatesOf(base);
    Embedding result = base;
    for (std::size_t i = 0; i < freeNumbers; ++i) {
        double value = base[i];
        for (std::size_t axis = 0; axis < axes_.size(); ++axis) {
            value += (coordinates[axis] - own[axis]) * spreads_[axis] * axes_[axis][i];
        }
        result[i] = static_cast<float>(value);
    }
    return result;
}

Embedding EmbeddingSpace::ofLabel(std::size_t label) const {
    Embedding result{};
    std::ranges::copy(model_.embedding(label), result.begin());
    std::ranges::copy(waveVectors_, result.begin() + freeNumbers);
    return result;
}

}  // namespace haptoflow::learning
