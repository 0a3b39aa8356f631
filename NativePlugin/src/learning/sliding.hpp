#pragma once

#include "model/model_header.hpp"
#include "recordings/prepared_recording.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::learning {

/// A slower tip counts as resting.
inline constexpr double minimumSlidingMps = 0.004;

/// The samples that show the material: usable, touching, sliding, and inside the model's range of speed.
struct Sliding {
    std::vector<std::uint8_t> isSliding;
    double seconds = 0.0;
    /// 2nd, 50th and 98th percentile while sliding.
    std::array<double, 3> speedMps{};
    std::array<double, 3> forceNewtons{};

    /// True if all samples from first to first + count slide.
    [[nodiscard]] bool holds(std::size_t first, std::size_t count) const;

    /// Number of sliding samples before each sample, and before the end: makes `holds` fast.
    std::vector<std::uint32_t> before;
};

/// Throws recordings::RecordingUnusable if there is no motion, too much speed, no force or too little sliding.
[[nodiscard]] Sliding findSliding(const recordings::PreparedRecording& recording, const model::ModelHeader& model);

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
