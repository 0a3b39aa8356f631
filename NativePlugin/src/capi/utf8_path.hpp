#pragma once

#include <cstring>
#include <filesystem>
#include <string>

namespace haptoflow::capi {

/// A caller's path, which is UTF-8 on every platform.
[[nodiscard]] inline std::filesystem::path utf8Path(const char* text) {
    const std::u8string utf8(text, text + std::strlen(text));
    return std::filesystem::path(utf8);
}

}  // namespace haptoflow::capi
