#pragma once

#include "recordings/recording_table.hpp"
#include "recordings/track.hpp"

namespace haptoflow::recordings {

/// The readings at which the tracker measured a new value: rows that repeat an older reading would look like rests and
/// jumps. Readings of a tip at rest are kept.
[[nodiscard]] Track readAnew(const Track& track);

/// The velocity, of width 2 in m/s; a speed lies along the first axis. From positions it is the slope of a cubic fitted
/// to 90 ms of evenly spaced readings (Savitzky-Golay), which averages out the tracker's resolution and has no bias at
/// constant speed or acceleration.
[[nodiscard]] Track velocityOf(const Track& motion, MotionForm form);

}  // namespace haptoflow::recordings
