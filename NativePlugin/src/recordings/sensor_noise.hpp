#pragma once

#include "recordings/frame_motion.hpp"
#include "recordings/short_time_spectrum.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::recordings {

enum class NoiseSource : std::uint8_t {
    /// No part of the recording shows it, or it is too weak to matter.
    none,
    /// Where the tip rests on the surface or in the air.
    rest,
    /// Where the tip moves so slowly that the level no longer follows the speed.
    quietPart
};

/// "none", "rest" or "quiet part", for reports.
[[nodiscard]] std::string_view nameOf(NoiseSource source);

/// The noise of the accelerometer, which is in every part of a recording alike.
struct SensorNoise {
    NoiseSource source = NoiseSource::none;
    double rmsMps2 = 0.0;
    /// Mean power of each bin of a ShortTimeSpectrum; empty where there is none.
    std::vector<double> power;
};

/// Finds the noise where the tip rests for 0.2 s or more in all, knocks left out; otherwise in the quiet part
/// (quiet_part.hpp). A rest that is louder than the quietest sliding is not believed: then the motion is wrong. Throws
/// RecordingUnusable if the recording is no stronger where the tip slides than where it rests.
[[nodiscard]] SensorNoise findSensorNoise(const SpectrumCells& power, std::span<const FrameMotion> motion);

}  // namespace haptoflow::recordings
