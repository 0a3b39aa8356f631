#pragma once

#include <nlohmann/json.hpp>

#include <string_view>

namespace haptoflow::model {

/// The deepest nesting of objects and arrays that a header may have.
inline constexpr int maximumJsonDepth = 32;

/// Parses strict JSON of at most maximumJsonDepth levels in which no object names a key twice; depth and keys are
/// checked before anything is built. Throws ModelError: damaged for broken syntax or text that is not UTF-8,
/// oversized for the depth, inconsistent for a repeated key.
[[nodiscard]] nlohmann::json parseBoundedJson(std::string_view text);

}  // namespace haptoflow::model
