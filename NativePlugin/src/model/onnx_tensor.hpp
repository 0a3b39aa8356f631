#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// The bytes are not a protobuf message. The message of the error names the problem but not its position.
class WireError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The encodings of a field; groups, which protobuf has deprecated, are refused.
enum class WireType : std::uint8_t { varint = 0, fixed64 = 1, bytes = 2, fixed32 = 5 };

/// One field of a protobuf message. Refers to the message.
struct WireField {
    std::uint32_t number = 0;
    WireType type = WireType::varint;
    /// The value of a varint or a fixed number; 0 otherwise.
    std::uint64_t value = 0;
    /// The bytes of a string, a message or a packed array; empty otherwise.
    std::span<const std::byte> bytes;

    [[nodiscard]] std::string_view text() const noexcept {
        return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
    }
};

/// Reads the fields of one protobuf message in order. Every length is checked against the remaining bytes; nothing is
/// copied and nothing recurses. Home-made: the protobuf library would be a large dependency of the plugin, and it
/// builds the whole message before the message can be checked.
class WireReader {
public:
    explicit WireReader(std::span<const std::byte> message) noexcept : rest_(message) {}

    /// The next field, or nothing at the end of the message. Throws WireError.
    [[nodiscard]] std::optional<WireField> next();
    /// The next number of a packed array of varints, or nothing at its end. Throws WireError.
    [[nodiscard]] std::optional<std::uint64_t> nextPacked();

private:
    [[nodiscard]] std::uint64_t varint();
    [[nodiscard]] std::span<const std::byte> take(std::uint64_t count);

    std::span<const std::byte> rest_;
};

/// The parts of an ONNX TensorProto that are checked before a runtime reads it.
struct OnnxTensor {
    std::string_view name;
    /// Empty if the content fits the dimensions; otherwise a sentence's predicate, with the tensor as its subject.
    std::string problem;
};

/// Parses a TensorProto; its numbers are counted but not read. Throws WireError.
[[nodiscard]] OnnxTensor readOnnxTensor(std::span<const std::byte> bytes);

}  // namespace haptoflow::model
