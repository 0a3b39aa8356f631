#pragma once

#include <filesystem>
#include <span>

namespace haptoflow::cli {

/// Writes one channel of 32-bit float samples, +-1, atomically: an interrupted or failed write leaves no half file.
/// Throws InputError naming the path.
void writeWav(const std::filesystem::path& path, std::span<const float> samples, int rateHz);

}  // namespace haptoflow::cli
