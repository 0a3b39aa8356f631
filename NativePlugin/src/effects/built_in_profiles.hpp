#pragma once

#include <span>
#include <string_view>

namespace haptoflow::effects {

struct BuiltInProfile {
    std::string_view name;
    std::string_view json;
};

/// The files of NativePlugin/profiles, compiled in by CMake.
[[nodiscard]] std::span<const BuiltInProfile> builtInProfiles() noexcept;

}  // namespace haptoflow::effects
