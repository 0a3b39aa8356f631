#pragma once

#include <array>
#include <vector>

namespace haptoflow::recordings {

/// Combines three axes of vibration at 2 kHz into one (DFT321, Landin et al. 2010): in frames of 35 ms, with the energy
/// of all axes and the phase of their sum; then filtered to the third-octave energies of all axes together, as in
/// training.
[[nodiscard]] std::vector<double> combineAxes(const std::array<std::vector<double>, 3>& axes);

}  // namespace haptoflow::recordings
