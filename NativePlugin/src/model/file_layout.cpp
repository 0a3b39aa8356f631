#include "model/file_layout.hpp"

#include "model/model_error.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <string>
#include <system_error>

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

std::uint64_t readUnsigned(std::span<const std::byte> file, std::size_t offset, std::size_t byteCount) {
    return model::readUnsigned(file.subspan(offset, byteCount));
}

void checkMagic(std::span<const std::byte> file) {
    const std::size_t present = std::min(file.size(), fileMagic.size());
    for (std::size_t index = 0; index < present; ++index) {
        if (std::to_integer<char>(file[index]) != fileMagic[index]) {
            throw ModelError(ModelStatus::notAModel,
                             "bytes 0 to 7 are not \"HAPTFLOW\": this is not a .haptoflow file");
        }
    }
    if (file.size() < prefixBytes) {
        throw ModelError(ModelStatus::truncated, "the file has " + std::to_string(file.size()) +
                                                     " bytes, and its first part alone takes 32: get it again");
    }
}

void checkPrefix(std::span<const std::byte> file) {
    if (crc32(file.first(28)) != readUnsigned(file, 28, 4)) {
        throw ModelError(ModelStatus::damaged, "bytes 0 to 27 do not match their checksum at byte 28: get it again");
    }
    const std::uint64_t version = readUnsigned(file, 8, 4);
    if (version != formatVersion) {
        const bool isNewer = version > formatVersion;
        throw ModelError(isNewer ? ModelStatus::tooNew : ModelStatus::inconsistent,
                         "format version " + std::to_string(version) + " at byte 8; this reader knows version " +
                             std::to_string(formatVersion) + ": " +
                             (isNewer ? "update HaptoFlow"
                                      : "make the file again from its training run with `haptoflow-training export`"));
    }
}

void checkLengths(std::span<const std::byte> file, std::uint64_t headerLength, std::uint64_t fileLength) {
    if (headerLength > maximumHeaderBytes || fileLength > maximumFileBytes) {
        throw ModelError(ModelStatus::oversized, "header of " + std::to_string(headerLength) +
                                                     " bytes (byte 12), file of " + std::to_string(fileLength) +
                                                     " (byte 16); the limits are 4194304 and 268435456");
    }
    if (fileLength > file.size()) {
        throw ModelError(ModelStatus::truncated, "the file says " + std::to_string(fileLength) +
                                                     " bytes (byte 16) and has " + std::to_string(file.size()) +
                                                     ": get it again");
    }
    if (fileLength < file.size()) {
        throw ModelError(ModelStatus::inconsistent, "the file says " + std::to_string(fileLength) +
                                                        " bytes (byte 16) and has " + std::to_string(file.size()) +
                                                        ": something was appended");
    }
    if (headerLength < 2 || headerLength > fileLength - prefixBytes ||
        (headerLength + prefixBytes) % blobAlignment != 0) {
        throw ModelError(ModelStatus::inconsistent,
                         "header length " + std::to_string(headerLength) +
                             " at byte 12; expected at least 2, inside the file, ending on a multiple of 64 bytes");
    }
}

}  // namespace

std::uint32_t crc32(std::span<const std::byte> bytes) noexcept {
    std::uint32_t remainder = 0xFFFFFFFFU;
    for (const std::byte value : bytes) {
        remainder = table[(remainder ^ std::to_integer<std::uint32_t>(value)) & 0xFFU] ^ (remainder >> 8U);
    }
    return remainder ^ 0xFFFFFFFFU;
}

std::vector<std::byte> readFile(const std::filesystem::path& path, std::uint64_t maximumBytes) {
    std::error_code failure;
    if (!std::filesystem::is_regular_file(path, failure)) {
        throw ModelError(ModelStatus::unreadable, "there is no such file");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, failure);
    if (failure) {
        throw ModelError(ModelStatus::unreadable, "cannot be read: " + failure.message());
    }
    if (size > maximumBytes) {
        throw ModelError(ModelStatus::oversized, "the file has " + std::to_string(size) + " bytes; the limit is " +
                                                     std::to_string(maximumBytes));
    }
    std::ifstream stream(path, std::ios::binary);
    std::vector<std::byte> bytes(static_cast<std::size_t>(size));
    if (!stream || !stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size))) {
        throw ModelError(ModelStatus::unreadable, "cannot be opened or read to its end");
    }
    return bytes;
}

FileLayout readLayout(std::span<const std::byte> file) {
    if (file.size() > maximumFileBytes) {
        throw ModelError(ModelStatus::oversized,
                         "the file has " + std::to_string(file.size()) + " bytes; the limit is 268435456");
    }
    checkMagic(file);
    checkPrefix(file);
    const std::uint64_t headerLength = readUnsigned(file, 12, 4);
    checkLengths(file, headerLength, readUnsigned(file, 16, 8));

    const auto header = file.subspan(prefixBytes, static_cast<std::size_t>(headerLength));
    if (crc32(header) != readUnsigned(file, 24, 4)) {
        throw ModelError(ModelStatus::damaged, "the JSON header does not match its checksum at byte 24: get it again");
    }
    const std::string_view padded(reinterpret_cast<const char*>(header.data()), header.size());
    const std::string_view text = padded.substr(0, padded.find_last_not_of(' ') + 1);
    if (text.size() < 2 || text.front() != '{' || text.back() != '}') {
        throw ModelError(ModelStatus::inconsistent,
                         "the JSON header at byte 32 is not one object followed by spaces only");
    }
    return {text, prefixBytes + header.size()};
}

}  // namespace haptoflow::model
