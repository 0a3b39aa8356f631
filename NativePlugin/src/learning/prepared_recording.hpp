#pragma once

#include "learning/recording.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::learning {

/// A recording as the network's clock has it: one axis at 2 kHz, 10 to 1000 Hz, with the motion of each sample.
struct PreparedRecording {
    /// m/s^2.
    std::vector<float> wave;
    /// vx, vy in m/s and force in N, each the mean of 20 ms.
    std::vector<std::array<float, 3>> motion;
    /// False in the neighbourhood of what was not finite or stood still by itself.
    std::vector<std::uint8_t> isUsable;
    /// Above it the recording has nothing, 475 to 950.
    double bandwidthHz = 0.0;

    [[nodiscard]] double speedMps(std::size_t sample) const;
};

/// Resamples (windowed sinc), combines three axes (DFT321) and filters without phase shift, as training does. Reads the
/// first `longestSeconds`. Call `checkRecording` before.
[[nodiscard]] PreparedRecording prepareRecording(const Recording& recording);

}  // namespace haptoflow::learning
