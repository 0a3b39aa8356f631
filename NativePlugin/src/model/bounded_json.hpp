#pragma once

#include <nlohmann/json.hpp>

#include <string_view>

namespace haptoflow::model {

/// Maximum nesting of objects and arrays in a document.
inline constexpr int maximumJsonDepth = 32;

/// Parses strict JSON of at most maximumJsonDepth levels in which no object has a key twice; nlohmann's parser builds
/// the values after depth and keys have been checked. Throws ModelError: damaged for broken syntax or text that is not
/// UTF-8, oversized for the depth, inconsistent for a repeated key. `document` is the text's name in messages.
[[nodiscard]] nlohmann::json parseBoundedJson(std::string_view text, std::string_view document = "the JSON header");

}  // namespace haptoflow::model
