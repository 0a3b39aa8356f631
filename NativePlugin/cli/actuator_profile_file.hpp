#pragma once

#include "effects/actuator_profile.hpp"

#include <string>

namespace haptoflow::cli {

/// A built-in profile by its name, else the profile in a file. Throws InputError naming the file and the key.
[[nodiscard]] effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath);

}  // namespace haptoflow::cli
