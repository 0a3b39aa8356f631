#pragma once

#include "recordings/recording.hpp"
#include "recordings/recording_table.hpp"
#include "recordings/track.hpp"

#include <string>
#include <vector>

namespace haptoflow::recordings {

/// Checks of what a sensor measured, before resampling hides it. Each throws RecordingUnusable that names file, line
/// where one is to blame, and column, what was found and what is expected. `notes` gets what a user should know of a
/// recording that can be used, one sentence each.

/// Units, strength, and clipping. Returns the track without the stretches in which the sensor gave the same value on
/// every axis for 0.2 s or longer. `columns` are names as in TableSeries.
[[nodiscard]] Track plausibleAcceleration(const std::string& path, const std::string& columns, Track acceleration,
                                          std::vector<std::string>& notes);

/// Units and jumps. `motion` is as in the file, `velocity` is its `velocityOf`.
void checkMotion(const std::string& path, const TableSeries& series, MotionForm form, const Track& motion,
                 const Track& velocity);

/// Units and spikes.
void checkForce(const std::string& path, const TableSeries& series, const Track& force);

/// A note if the level follows the speed clearly better where the motion is shifted by 50 ms or more: sensors of
/// different clocks.
void noteLag(const std::string& path, const Recording& recording, std::vector<std::string>& notes);

}  // namespace haptoflow::recordings
