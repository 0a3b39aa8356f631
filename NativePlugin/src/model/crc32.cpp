#include "model/crc32.hpp"

#include <array>

namespace haptoflow::model {
namespace {

constexpr std::array<std::uint32_t, 256> makeTable() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t value = 0; value < table.size(); ++value) {
        std::uint32_t remainder = value;
        for (int bit = 0; bit < 8; ++bit) {
            remainder = (remainder & 1U) != 0 ? (remainder >> 1U) ^ 0xEDB88320U : remainder >> 1U;
        }
        table.at(value) = remainder;
    }
    return table;
}

constexpr std::array<std::uint32_t, 256> table = makeTable();

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
    std::uint32_t remainder = 0xFFFFFFFFU;
    for (const std::byte value : bytes) {
        remainder = table[(remainder ^ std::to_integer<std::uint32_t>(value)) & 0xFFU] ^ (remainder >> 8U);
    }
    return remainder ^ 0xFFFFFFFFU;
}

}  // namespace haptoflow::model
