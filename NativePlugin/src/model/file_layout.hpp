#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace haptoflow::model {

/// CRC-32 of zlib and PNG: polynomial 0x04C11DB7, reflected, start and final exclusive-or 0xFFFFFFFF. Home-made: these
/// lines save the plugin a link to zlib on every platform.
[[nodiscard]] std::uint32_t crc32(std::span<const std::byte> bytes) noexcept;

/// The little-endian number in at most eight bytes.
[[nodiscard]] inline std::uint64_t readUnsigned(std::span<const std::byte> bytes) noexcept {
    std::uint64_t value = 0;
    for (std::size_t index = bytes.size(); index > 0; --index) {
        value = (value << 8U) | std::to_integer<std::uint64_t>(bytes[index - 1]);
    }
    return value;
}

inline constexpr std::string_view fileMagic = "HAPTFLOW";
inline constexpr std::uint32_t formatVersion = 2;
inline constexpr std::size_t prefixBytes = 32;
inline constexpr std::size_t blobAlignment = 64;
inline constexpr std::uint64_t maximumHeaderBytes = 4'194'304;
inline constexpr std::uint64_t maximumFileBytes = 268'435'456;

/// Reads a file of at most `maximumBytes`. Throws ModelError: unreadable, or oversized.
[[nodiscard]] std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t maximumBytes);

/// Position of the JSON header, after the first 32 bytes and the header's checksum have been verified.
struct FileLayout {
    /// The header without the spaces that pad it.
    std::string_view headerText;
    /// Offset of the first byte after the header; a multiple of 64.
    std::size_t headerEnd = 0;
};

/// Checks the first 32 bytes and the header's checksum and padding. The result refers to `file`. Throws ModelError.
[[nodiscard]] FileLayout readLayout(std::span<const std::byte> file);

}  // namespace haptoflow::model
