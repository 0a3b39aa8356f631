#pragma once

#include "recordings/frame_motion.hpp"
#include "recordings/short_time_spectrum.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// Numbers of frames of a ShortTimeSpectrum, ascending.
using Frames = std::vector<std::size_t>;

/// The usable frames of which `condition` holds.
template <typename Condition>
[[nodiscard]] Frames framesWhere(std::span<const FrameMotion> motion, Condition condition) {
    Frames frames;
    for (std::size_t frame = 0; frame < motion.size(); ++frame) {
        if (motion[frame].isUsable && condition(motion[frame])) {
            frames.push_back(frame);
        }
    }
    return frames;
}

/// Mean square of each frame.
[[nodiscard]] std::vector<double> meanSquaresOf(const SpectrumCells& power, const Frames& frames);

[[nodiscard]] std::vector<double> meanSpectrum(const SpectrumCells& power, std::span<const std::size_t> frames);

/// Mean over two bins on each side: noise has a smooth spectrum, and few frames of it a rough one.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> spectrum);

/// Of one value or more.
[[nodiscard]] double meanOf(std::span<const double> values);

/// The value below which `share` of one value or more lies.
[[nodiscard]] double quantile(std::vector<double> values, double share);

}  // namespace haptoflow::recordings
