#include "engine/object_embedding.hpp"

#include "inference/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

namespace haptoflow::engine {
namespace {

constexpr float largestDeviation = 2.5F;
// Of a standard normal number that is limited to that. With the density p and the distribution P, its variance is
// 2 P(2.5) - 1 - 5 p(2.5) + 2 * 2.5^2 (1 - P(2.5)).
constexpr double limitedDeviation = 0.988716;
// Voices are numbered from 0.
constexpr std::uint32_t noVoice = std::numeric_limits<std::uint32_t>::max();

}  // namespace

std::array<float, model::embeddingSize> embeddingOf(const PreparedMaterial& material, ObjectIdentity object) noexcept {
    std::array<float, model::embeddingSize> embedding{};
    std::ranges::copy(material.embedding, embedding.begin());
    const std::size_t pieces = std::min(material.pieceOffsets.size() / model::textureSize, model::maximumPieces);
    if (object.variation == 0.0F || pieces < 2) {
        return embedding;
    }
    std::array<float, model::maximumPieces> numbers{};
    const auto drawn = std::span(numbers).first(pieces);
    inference::fillStandardNormal({.seed = object.surfaceSeed, .voice = noVoice}, drawn);
    std::array<double, model::textureSize> offset{};
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        const auto number = static_cast<double>(std::clamp(drawn[piece], -largestDeviation, largestDeviation));
        const auto own = material.pieceOffsets.subspan(piece * model::textureSize).first<model::textureSize>();
        for (std::size_t j = 0; j < offset.size(); ++j) {
            offset[j] += number * static_cast<double>(own[j]);
        }
    }
    const double scale =
        static_cast<double>(object.variation) / (limitedDeviation * std::sqrt(static_cast<double>(pieces - 1)));
    for (std::size_t j = 0; j < offset.size(); ++j) {
        embedding[j] = static_cast<float>(static_cast<double>(embedding[j]) + scale * offset[j]);
    }
    return embedding;
}

}  // namespace haptoflow::engine
