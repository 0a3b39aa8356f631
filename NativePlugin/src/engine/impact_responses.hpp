#pragma once

#include "effects/strikes.hpp"
#include "engine/material_library.hpp"
#include "model/model_header.hpp"

namespace haptoflow::engine {

/// Impact response of a label, from the first of these that there is:
/// - the header's modes, unless the main one only repeats what follows from the stiffness k in N/m: f = 5 sqrt(k) Hz,
///   25 to 450 Hz (materials of one stiffness, such as metal and glass, would sound alike);
/// - the tap on the piece of the label's name or category (tap_pieces.hpp), with the header's restitution;
/// - one mode of that f, a decay of 60 + 0.15 f per second and an amplitude of 0.15 * 2 pi f m/s^2 per m/s. The form
///   follows from a mass m that strikes a spring at speed v: v sqrt(k / m) sin(sqrt(k / m) t). The constants give about
///   90, 170 and 320 Hz for 300, 1200 and 4000 N/m and account for the damping by the hand.
[[nodiscard]] effects::ImpactResponse impactResponse(const model::Label& label) noexcept;

/// Impact response of a blend: the weighted mean of its materials; frequencies and decays are averaged as logarithms.
[[nodiscard]] effects::ImpactResponse impactResponse(const Ingredients& ingredients) noexcept;

}  // namespace haptoflow::engine
