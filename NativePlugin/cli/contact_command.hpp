#pragma once

#include "headless/contact_tracker.hpp"
#include "headless/scenes/stroke_file.hpp"

#include <iosfwd>
#include <string>

namespace haptoflow::cli {

/// Plays the stroke in the scene at the scene's update rate, or in frames at its own samples, and writes one CSV line
/// per frame. Throws InputError if the stroke, named `strokeName`, is too long.
void writeContactStates(std::ostream& output, const headless::Scene& scene, const headless::Stroke& stroke,
                        const std::string& strokeName, const headless::ContactSettings& settings,
                        bool asRecorded = false);

}  // namespace haptoflow::cli
