#pragma once

#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::learning {

/// About 35 mm of fairly straight sliding, whitened and placed on the surface.
struct PathWindow {
    /// Behind the Hann window.
    std::vector<double> wave;
    /// The Hann window, and its sum.
    std::vector<double> hann;
    double hannSum = 0.0;
    /// From the window's middle.
    std::vector<double> xMm;
    std::vector<double> yMm;
    /// Of unit length, from the window's beginning to its end.
    double directionX = 0.0;
    double directionY = 0.0;
    double pathMm = 0.0;
    double speedMmps = 0.0;
};

/// At most 200 windows, half overlapped, evenly drawn from all there are. None spans a sample that is not usable: each
/// usable stretch counts as a recording of its own. Training does the same (preprocessing/path_windows.py).
[[nodiscard]] std::vector<PathWindow> pathWindows(const PreparedRecording& recording, const Sliding& sliding);

}  // namespace haptoflow::learning
