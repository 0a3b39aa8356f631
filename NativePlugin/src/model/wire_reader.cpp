#include "model/wire_reader.hpp"

#include <string>

namespace haptoflow::model {
namespace {

constexpr std::size_t maximumVarintBytes = 10;
constexpr std::uint64_t maximumFieldNumber = 536'870'911;

}  // namespace

std::optional<WireField> WireReader::next() {
    if (rest_.empty()) {
        return std::nullopt;
    }
    const std::uint64_t tag = varint();
    const std::uint64_t number = tag >> 3U;
    if (number < 1 || number > maximumFieldNumber) {
        throw WireError("a field has the number " + std::to_string(number));
    }
    WireField field;
    field.number = static_cast<std::uint32_t>(number);
    switch (tag & 7U) {
        case 0:
            field.value = varint();
            return field;
        case 1:
            field.type = WireType::fixed64;
            field.value = fixed(8);
            return field;
        case 2:
            field.type = WireType::bytes;
            field.bytes = take(varint());
            return field;
        case 5:
            field.type = WireType::fixed32;
            field.value = fixed(4);
            return field;
        default:
            throw WireError("a field has an encoding that protobuf does not have");
    }
}

std::optional<std::uint64_t> WireReader::nextPacked() {
    if (rest_.empty()) {
        return std::nullopt;
    }
    return varint();
}

std::uint64_t WireReader::varint() {
    std::uint64_t value = 0;
    for (std::size_t index = 0; index < maximumVarintBytes; ++index) {
        const auto byte = std::to_integer<std::uint64_t>(take(1).front());
        value |= (byte & 0x7FU) << (7 * index);
        if (byte < 0x80U) {
            return value;
        }
    }
    throw WireError("a number is longer than ten bytes");
}

std::span<const std::byte> WireReader::take(std::uint64_t count) {
    if (count > rest_.size()) {
        throw WireError("a length reaches beyond the end");
    }
    const auto taken = rest_.first(static_cast<std::size_t>(count));
    rest_ = rest_.subspan(taken.size());
    return taken;
}

std::uint64_t WireReader::fixed(std::size_t byteCount) {
    std::uint64_t value = 0;
    std::size_t shift = 0;
    for (const std::byte byte : take(byteCount)) {
        value |= std::to_integer<std::uint64_t>(byte) << shift;
        shift += 8;
    }
    return value;
}

}  // namespace haptoflow::model
