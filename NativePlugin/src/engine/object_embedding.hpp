#pragma once

#include "engine/prepared_material.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstdint>

namespace haptoflow::engine {

/// Which object of its labels a surface is: ContactState::surfaceSeed and ContactState::variation.
struct ObjectIdentity {
    std::uint32_t surfaceSeed = 0;
    /// 0 to 1.
    float variation = 0.0F;
};

/// The embedding of a material for one object: the material's own plus an offset drawn by the seed, so that objects
/// have the mean and, at a variation of 1, the covariance of the recorded pieces. With the offsets e_s of S pieces,
/// which add up to zero, that is variation * sum_s n_s e_s / sqrt(S - 1), where n_s are independent numbers of mean 0
/// and variance 1: normal ones, limited so that freaks are rare. The same seed draws the same numbers for every
/// label and on every platform. Wave vectors have no offset; a material without recorded pieces, or with a single
/// one, has none at all.
///
/// Any thread; allocates nothing.
[[nodiscard]] std::array<float, model::embeddingSize> embeddingOf(const PreparedMaterial& material,
                                                                  ObjectIdentity object) noexcept;

}  // namespace haptoflow::engine
