#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::model {

/// CRC-32 of zlib and PNG: polynomial 0x04C11DB7, reflected, start and final exclusive-or 0xFFFFFFFF. Home-made: these
/// lines save the plugin a link to zlib on every platform.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes) noexcept;

}  // namespace haptoflow::model
