#pragma once

#include "inference/skeleton_model.hpp"
#include "model/model_builder.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <type_traits>

namespace haptoflow::engine::testing {

/// A small model for tests of the engine, with labels, ranges and seeds but without runnable graphs. Range: 0.01-0.4
/// m/s, 0.1-4 N; labels "oak" and "metal mesh".
inline model::ModelFile smallModel() {
    return model::ModelFile::parse(model::testing::ModelBuilder{}.build());
}

/// A model whose filters ring for a few milliseconds and that has no rare impulses, so that a tenth of a second has a
/// level.
inline model::ModelFile calmSkeletonModel() {
    auto builder = skeleton::testing::skeletonModel({.seed = 5, .strength = 0.3F});
    for (const std::string part : {"weight", "bias"}) {
        auto& bytes = blobOf(builder, "skeleton.4." + part).bytes;
        constexpr std::size_t impulseShare = 2 * skeleton::thresholdCount * skeleton::atomCount;
        std::ranges::fill(
            bytes.end() - static_cast<std::ptrdiff_t>(bytes.size() * impulseShare / skeleton::output::count),
            bytes.end(), static_cast<std::remove_reference_t<decltype(bytes[0])>>(0));
    }
    return skeleton::testing::read(builder);
}

}  // namespace haptoflow::engine::testing
