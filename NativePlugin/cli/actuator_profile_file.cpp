#include "actuator_profile_file.hpp"

#include "exit_codes.hpp"
#include "input_file.hpp"

#include <optional>
#include <utility>

namespace haptoflow::cli {

effects::ActuatorProfile readActuatorProfile(const std::string& nameOrPath) {
    if (std::optional<effects::ActuatorProfile> builtIn = effects::ActuatorProfile::builtIn(nameOrPath)) {
        return *std::move(builtIn);
    }
    const std::string text =
        readInputFile(nameOrPath, "an actuator profile (JSON), or the name of a built-in one: flat, voice-coil");
    try {
        return effects::ActuatorProfile::parse(text);
    } catch (const effects::ProfileError& error) {
        throw InputError(nameOrPath + ": " + error.what());
    }
}

}  // namespace haptoflow::cli
