#include "recordings/frame_motion.hpp"

#include "recordings/short_time_spectrum.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::recordings {
namespace {

/// A tracker's noise gives a resting tip this speed now and then, but not for long.
constexpr double restMps = 0.004;
constexpr double meanRestMps = 0.002;
/// A hand in the air is never as still as on a surface.
constexpr double restInAirMps = 0.02;
/// The filters ring, and the means of the motion reach, for this long.
constexpr std::size_t restMarginSamples = 100;

/// How often something holds before each sample, and before the end.
class Count {
public:
    template <typename Condition>
    Count(std::size_t samples, Condition condition) : before_(samples + 1) {
        for (std::size_t i = 0; i < samples; ++i) {
            before_[i + 1] = before_[i] + (condition(i) ? 1U : 0U);
        }
    }

    [[nodiscard]] bool isFull(std::size_t first, std::size_t end) const {
        return before_[end] - before_[first] == end - first;
    }

private:
    std::vector<std::uint32_t> before_;
};

std::array<double, 3> meanOf(std::span<const std::array<float, 3>> motion) {
    std::array<double, 3> mean{};
    for (const std::array<float, 3>& each : motion) {
        for (std::size_t axis = 0; axis < mean.size(); ++axis) {
            mean[axis] += static_cast<double>(each[axis]) / static_cast<double>(motion.size());
        }
    }
    return mean;
}

}  // namespace

std::vector<FrameMotion> motionOfFrames(std::size_t frames, std::span<const std::array<float, 3>> motion,
                                        std::span<const std::uint8_t> isUsable) {
    constexpr std::size_t hop = ShortTimeSpectrum::hop;
    constexpr std::size_t length = ShortTimeSpectrum::frameSamples;
    const std::size_t count = motion.size();
    const auto speedAt = [&](std::size_t i) {
        return std::hypot(static_cast<double>(motion[i][0]), static_cast<double>(motion[i][1]));
    };
    const Count usable(count, [&](std::size_t i) { return isUsable[i] != 0; });
    const Count resting(count, [&](std::size_t i) {
        const bool isInAir = motion[i][2] < lightestTouchNewtons;
        return isUsable[i] != 0 && speedAt(i) < (isInAir ? restInAirMps : restMps);
    });
    std::vector<FrameMotion> result(frames);
    for (std::size_t frame = 1; frame < frames; ++frame) {
        const std::size_t first = (frame - 1) * hop;
        const std::size_t end = first + length;
        if (end > count || !usable.isFull(first, end)) {
            continue;
        }
        FrameMotion& each = result[frame];
        each.isUsable = true;
        const std::size_t from = first - std::min(first, restMarginSamples);
        const std::size_t to = std::min(end + restMarginSamples, count);
        const std::array<double, 3> around = meanOf(motion.subspan(from, to - from));
        each.isResting = resting.isFull(from, to) &&
                         (around[2] < lightestTouchNewtons || std::hypot(around[0], around[1]) < meanRestMps);
        each.isTouching = meanOf(motion.subspan(first, length))[2] >= lightestTouchNewtons;
        for (std::size_t i = first; i < end; ++i) {
            each.speedMps += speedAt(i) / static_cast<double>(length);
        }
    }
    return result;
}

}  // namespace haptoflow::recordings
