#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::recordings {

inline constexpr double lightestTouchNewtons = 0.02;

/// How the tip moves during one frame of a ShortTimeSpectrum.
struct FrameMotion {
    /// False at the ends of the recording and where the motion is unknown; the other members then mean nothing.
    bool isUsable = false;
    /// The tip rests from 50 ms before the frame to 50 ms after it.
    bool isResting = false;
    bool isTouching = false;
    double speedMps = 0.0;
};

/// For each frame. `motion`, for each sample: vx, vy in m/s and force in N.
[[nodiscard]] std::vector<FrameMotion> motionOfFrames(std::size_t frames, std::span<const std::array<float, 3>> motion,
                                                      std::span<const std::uint8_t> isUsable);

}  // namespace haptoflow::recordings
