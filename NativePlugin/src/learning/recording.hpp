#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>

namespace haptoflow::learning {

/// Nothing can be learnt from a recording. The message says why, and what would do.
class RecordingUnusable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// One material under a tip, evenly sampled. The spans stay the caller's. A sample of which any value is not finite
/// costs its neighbourhood.
struct Recording {
    double rateHz = 0.0;
    /// 1 or 3, interleaved.
    std::size_t axisCount = 1;
    /// m/s^2, with gravity or without.
    std::span<const float> accelerationMps2{};
    /// vx, vy in m/s for each sample; empty where the motion is constant.
    std::span<const float> velocityMps{};
    std::array<double, 2> constantVelocityMps{};
    /// One for each sample; empty where the force is constant.
    std::span<const float> forceNewtons{};
    double constantForceNewtons = 0.0;

    [[nodiscard]] std::size_t sampleCount() const { return axisCount > 0 ? accelerationMps2.size() / axisCount : 0; }
    [[nodiscard]] double seconds() const { return static_cast<double>(sampleCount()) / rateHz; }
};

inline constexpr double lowestRateHz = 1000.0;
inline constexpr double highestRateHz = 192'000.0;
/// No hand moves a tip faster, in m/s: a larger number is in another unit.
inline constexpr double maximumHandSpeedMps = 10.0;
/// What is behind this is not read.
inline constexpr double longestSeconds = 300.0;
/// Less sliding than this is refused.
inline constexpr double shortestSlidingSeconds = 3.0;

/// Throws std::invalid_argument where the spans' sizes do not belong together or a number is outside its range, and
/// RecordingUnusable where the samples are of no use: too short, silent, clipped, not finite.
void checkRecording(const Recording& recording);

}  // namespace haptoflow::learning
