#pragma once

#include "recordings/recording.hpp"

#include <string>
#include <vector>

namespace haptoflow::recordings {

/// Checks sign and zero of a measured force against the motion and the vibration, where all are on the recording's
/// samples. `force` is as measured, with negative values. Throws RecordingUnusable that names `path`, `column`, how
/// much of the sliding has a negative force, and the keys of `sidecar` that correct it; `notes` gets a sentence if
/// smaller values than nothing will be taken as nothing, if the sensor measures a force where the tip moves and touches
/// nothing, or if the force drifts and the level does not follow.
void checkForceZero(const std::string& path, const std::string& column, const std::string& sidecar,
                    const Recording& recording, std::vector<std::string>& notes);

}  // namespace haptoflow::recordings
