#pragma once

#include "headless/contact_tracker.hpp"
#include "stroke_file.hpp"

#include <iosfwd>
#include <string>

namespace haptoflow::cli {

/// Plays the stroke over the scene at the scene's update rate and writes one CSV line per frame. Throws InputError
/// when the stroke, called `strokeName`, is too long.
void writeContactStates(std::ostream& output, const headless::Scene& scene, const Stroke& stroke,
                        const std::string& strokeName, const headless::ContactSettings& settings);

}  // namespace haptoflow::cli
