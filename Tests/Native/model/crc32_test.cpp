#include "model/file_layout.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string_view>

namespace haptoflow::model {
namespace {

std::uint32_t crcOf(std::string_view text) {
    return crc32(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(Crc32Test, ChecksTheNineDigitsToThePublishedValue) {
    EXPECT_EQ(crcOf("123456789"), 0xCBF43926U);
}

TEST(Crc32Test, OfNothingIsZero) {
    EXPECT_EQ(crcOf(""), 0U);
}

TEST(Crc32Test, AgreesWithZlibOnASentence) {
    EXPECT_EQ(crcOf("The quick brown fox jumps over the lazy dog"), 0x414FA339U);
}

TEST(Crc32Test, AgreesWithZlibOnAllByteValues) {
    std::array<std::byte, 256> bytes{};
    for (std::size_t index = 0; index < bytes.size(); ++index) {
        bytes.at(index) = static_cast<std::byte>(index);
    }
    EXPECT_EQ(crc32(bytes), 0x29058C73U);
}

}  // namespace
}  // namespace haptoflow::model
