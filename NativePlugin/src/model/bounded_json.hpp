#pragma once

#include <nlohmann/json.hpp>

#include <string_view>

namespace haptoflow::model {

/// The deepest nesting of objects and arrays that a document may have.
inline constexpr int maximumJsonDepth = 32;

/// Parses strict JSON of at most maximumJsonDepth levels in which no object names a key twice; depth and keys are
/// checked before anything is built. Throws ModelError: damaged for broken syntax or text that is not UTF-8,
/// oversized for the depth, inconsistent for a repeated key. `document` is what messages call the text.
[[nodiscard]] nlohmann::json parseBoundedJson(std::string_view text, std::string_view document = "the JSON header");

}  // namespace haptoflow::model
