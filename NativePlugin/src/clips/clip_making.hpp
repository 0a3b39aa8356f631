#pragma once

#include "clips/haptic_clip.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::clips {

struct ClipMaking {
    /// Range of the carrier. From 50 Hz on, effects::WaveFeatures leaves the frequencies of textures as they are.
    double minFrequencyHz = 50.0;
    double maxFrequencyHz = 400.0;
    /// True for a wave that continues at its beginning, such as `loopOf` makes: so does the clip.
    bool isLoop = false;
    ClipOrigin origin{};
};

/// The clip of a 2 kHz wave in m/s^2, for a device with amplitude and frequency: frames of 4 ms of
/// effects::WaveFeatures (perceived intensity of the wave), their amplitude by the loudness law of such devices. A
/// transient takes its energy out of the amplitude around its onset and has it in a pulse of 22 ms. Samples that are
/// not finite count as 0. Throws ClipError for an empty wave or one that is longer than a clip may be,
/// std::invalid_argument for a range out of bounds. Allocates.
[[nodiscard]] HapticClip clipOf(std::span<const float> waveMps2, const ClipMaking& making = {});

/// A loop of `shortest` to `longest` samples out of a longer wave, which must hold `longest` + `crossfade`. It is as
/// long as the wave's end resembles its beginning best, and its first `crossfade` samples lead from the one into the
/// other with gains that keep the level of their sum whatever their correlation: neither click nor dip where it closes.
/// Its length is a multiple of `step`. Throws std::invalid_argument. Allocates.
[[nodiscard]] std::vector<float> loopOf(std::span<const float> wave, std::size_t shortest, std::size_t longest,
                                        std::size_t crossfade, std::size_t step = 1);

/// Fewer points of a curve that stays within the tolerance of the given one everywhere.
struct Thinned {
    std::vector<ClipPoint> points{};
    /// Largest error in dB of any given point's value, values below `floor` counted as it.
    double errorDb = 0.0;
};

/// Leaves out points as long as the straight line between those that stay is within `toleranceDb` of each, values below
/// `floor` counted as it; if more than `mostPoints` would stay, with the least tolerance at which they do not. First
/// and last point stay. `floor` and `toleranceDb` are above 0, `mostPoints` is at least 2.
[[nodiscard]] Thinned thin(std::span<const ClipPoint> points, double toleranceDb, double floor, std::size_t mostPoints);

}  // namespace haptoflow::clips
