#pragma once

#include "learning/sliding.hpp"
#include "recordings/prepared_recording.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::learning {

/// About 35 mm of fairly straight sliding, whitened, with its path on the surface.
struct PathWindow {
    /// Multiplied by the Hann window.
    std::vector<double> wave;
    /// The Hann window and its sum.
    std::vector<double> hann;
    double hannSum = 0.0;
    /// Path relative to the window's middle.
    std::vector<double> xMm;
    std::vector<double> yMm;
    /// Unit vector from the window's start to its end.
    double directionX = 0.0;
    double directionY = 0.0;
    double pathMm = 0.0;
    double speedMmps = 0.0;
};

/// At most 200 windows, half overlapping, evenly chosen from all. No window contains an unusable sample: each usable
/// stretch is treated as a separate recording.
[[nodiscard]] std::vector<PathWindow> pathWindows(const recordings::PreparedRecording& recording,
                                                  const Sliding& sliding);

}  // namespace haptoflow::learning
