#pragma once

#include "engine/material_library.hpp"
#include "engine/rib_phase.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_header.hpp"

#include <array>

namespace haptoflow::engine {

/// What the ribs and slips of a material do beyond its wave vectors.
struct WaveStatistics {
    /// By slot of the wave vectors; without turns for even ribs.
    std::array<model::RibWander, inference::ribCount> ribs{};
    /// Without length for a material that does not slip.
    model::StickSlip slip{};
};

/// Of a material or blend whose wave vectors are `vectors` (assignRibs): ribs keep what their own material says of
/// them; slips are those of the heaviest material that slips.
[[nodiscard]] WaveStatistics waveStatisticsOf(const Ingredients& ingredients, const WaveVectors& vectors) noexcept;

}  // namespace haptoflow::engine
