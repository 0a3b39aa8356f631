#pragma once

#include "effects/strikes.hpp"
#include "engine/material_library.hpp"
#include "model/model_header.hpp"

namespace haptoflow::engine {

/// How a label answers a blow: as the model says, else by the law for its stiffness k in N/m: one mode of
/// f = 5 sqrt(k) Hz (25 to 450), which decays by 60 + 0.15 f a second and begins with 0.15 * 2 pi f m/s^2 for each m/s.
/// A tip of mass m that strikes a spring at v answers with v sqrt(k / m) sin(sqrt(k / m) t); the constants put rubber,
/// wood and stone at about 90, 170 and 320 Hz, and leave to the hand what it damps.
[[nodiscard]] effects::ImpactResponse impactResponse(const model::Label& label) noexcept;

/// Of a blend: the weighted mean, of frequencies and decays as logarithms.
[[nodiscard]] effects::ImpactResponse impactResponse(const Ingredients& ingredients) noexcept;

}  // namespace haptoflow::engine
