#pragma once

#include <filesystem>

namespace haptoflow::inference {

/// Opens the library at `path` and returns the address of `symbol` in it. The library stays loaded until the process
/// ends: ONNX Runtime keeps threads and thread-local state that do not survive being unloaded.
/// Throws RuntimeUnavailable naming the path.
[[nodiscard]] void* loadSymbol(const std::filesystem::path& path, const char* symbol);

}  // namespace haptoflow::inference
