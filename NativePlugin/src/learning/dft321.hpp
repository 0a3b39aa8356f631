#pragma once

#include <array>
#include <vector>

namespace haptoflow::learning {

/// Three axes of vibration at 2 kHz into one (DFT321, Landin et al. 2010): the energy of all axes, the phase of their
/// sum, in frames of 35 ms; then filtered to the third-octave energies of the axes together, as training does.
[[nodiscard]] std::vector<double> combineAxes(const std::array<std::vector<double>, 3>& axes);

}  // namespace haptoflow::learning
