#include "model/onnx_tensor.hpp"

#include "model/file_layout.hpp"
#include "model/model_header.hpp"

namespace haptoflow::model {
namespace {

constexpr std::size_t maximumVarintBytes = 10;
constexpr std::uint64_t maximumFieldNumber = 536'870'911;

// The numbers of TensorProto's fields in onnx.proto.
constexpr std::uint32_t dimsField = 1, typeField = 2, floatsField = 4, int32sField = 5, int64sField = 7;
constexpr std::uint32_t nameField = 8, rawField = 9, doublesField = 10, docField = 12, externalField = 13;
constexpr std::uint32_t locationField = 14, metadataField = 16;

struct Content {
    std::uint64_t elements = 1;
    std::size_t rank = 0;
    std::uint64_t type = 0;
    std::optional<std::size_t> rawBytes;
    std::uint64_t typedNumbers = 0;
    bool isExternal = false;
    bool isTooLarge = false;
};

/// Bytes of one number; 0 for a type that graphs of a model file may not use.
std::size_t numberBytes(std::uint64_t type) {
    switch (type) {
        case 1:  // float
        case 6:  // int32
            return 4;
        case 7:   // int64
        case 11:  // double
            return 8;
        case 9:  // bool
            return 1;
        default:
            return 0;
    }
}

std::uint64_t varintsIn(std::span<const std::byte> packed) {
    std::uint64_t count = 0;
    for (WireReader reader(packed); reader.nextPacked();) {
        ++count;
    }
    return count;
}

void addDimension(Content& content, std::uint64_t dimension) {
    ++content.rank;
    // No tensor has more numbers than the file has bytes. A negative dimension is read as a very large one.
    if (dimension > maximumFileBytes || content.elements * dimension > maximumFileBytes) {
        content.isTooLarge = true;
    } else {
        content.elements *= dimension;
    }
}

void addDimensions(Content& content, const WireField& field) {
    if (field.type == WireType::varint) {
        addDimension(content, field.value);
        return;
    }
    WireReader reader(field.bytes);
    while (const auto dimension = reader.nextPacked()) {
        addDimension(content, *dimension);
    }
}

std::string problemOf(const Content& content) {
    const std::size_t bytes = numberBytes(content.type);
    if (content.isExternal) {
        return "is in another file; export the graph with its weights inside";
    }
    if (bytes == 0) {
        return "is of type " + std::to_string(content.type) + "; expected float, double, int32, int64 or bool";
    }
    if (content.rank > maximumTensorRank) {
        return "has " + std::to_string(content.rank) + " dimensions; the limit is 8";
    }
    const bool fits = !content.isTooLarge &&
                      (content.rawBytes ? content.typedNumbers == 0 && *content.rawBytes == content.elements * bytes
                                        : content.typedNumbers == content.elements);
    return fits ? "" : "has another number of values than its dimensions";
}

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
            field.value = readUnsigned(take(8));
            return field;
        case 2:
            field.type = WireType::bytes;
            field.bytes = take(varint());
            return field;
        case 5:
            field.type = WireType::fixed32;
            field.value = readUnsigned(take(4));
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

OnnxTensor readOnnxTensor(std::span<const std::byte> bytes) {
    OnnxTensor tensor;
    Content content;
    WireReader reader(bytes);
    while (const auto field = reader.next()) {
        const bool isPacked = field->type == WireType::bytes;
        switch (field->number) {
            case dimsField:
                addDimensions(content, *field);
                break;
            case typeField:
                content.type = field->value;
                break;
            case floatsField:
                content.typedNumbers += isPacked ? field->bytes.size() / 4 : 1;
                break;
            case doublesField:
                content.typedNumbers += isPacked ? field->bytes.size() / 8 : 1;
                break;
            case int32sField:
            case int64sField:
                content.typedNumbers += isPacked ? varintsIn(field->bytes) : 1;
                break;
            case rawField:
                content.rawBytes = field->bytes.size();
                break;
            case nameField:
                tensor.name = field->text();
                break;
            case locationField:
                content.isExternal = content.isExternal || field->value != 0;
                break;
            case externalField:
                content.isExternal = true;
                break;
            case docField:
            case metadataField:
                break;
            default:
                tensor.problem = "has the field " + std::to_string(field->number) +
                                 ", which is no number of float, double, int32, int64 or bool";
        }
    }
    if (tensor.problem.empty()) {
        tensor.problem = problemOf(content);
    }
    return tensor;
}

}  // namespace haptoflow::model
