#pragma once

#include "model_builder.hpp"

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::model::testing {

/// Writes one protobuf message, field by field.
class WireWriter {
public:
    WireWriter& number(std::uint32_t field, std::uint64_t value) {
        varint(std::uint64_t{field} << 3U);
        varint(value);
        return *this;
    }
    WireWriter& bytes(std::uint32_t field, const Bytes& content) {
        varint(std::uint64_t{field} << 3U | 2U);
        varint(content.size());
        bytes_.insert(bytes_.end(), content.begin(), content.end());
        return *this;
    }
    WireWriter& text(std::uint32_t field, std::string_view content) {
        Bytes letters(content.size());
        std::transform(content.begin(), content.end(), letters.begin(), [](char letter) { return std::byte(letter); });
        return bytes(field, letters);
    }
    WireWriter& message(std::uint32_t field, const WireWriter& content) { return bytes(field, content.bytes_); }
    [[nodiscard]] const Bytes& written() const { return bytes_; }

private:
    void varint(std::uint64_t value) {
        for (; value >= 0x80U; value >>= 7U) {
            bytes_.push_back(static_cast<std::byte>(value | 0x80U));
        }
        bytes_.push_back(static_cast<std::byte>(value));
    }

    Bytes bytes_;
};

using Names = std::vector<std::string>;
using Dimensions = std::vector<std::int64_t>;

inline constexpr std::uint64_t onnxFloat = 1;
inline constexpr std::uint64_t onnxInt64 = 7;

/// An attribute of an operator.
inline WireWriter integerAttribute(std::string_view name, std::int64_t value) {
    return WireWriter().text(1, name).number(3, static_cast<std::uint64_t>(value)).number(20, 2);
}
inline WireWriter graphAttribute(std::string_view name, const WireWriter& graph) {
    return WireWriter().text(1, name).message(6, graph).number(20, 5);
}

/// A TensorProto with its numbers as raw bytes.
inline WireWriter rawTensor(std::string_view name, std::uint64_t type, const Dimensions& dimensions, const Bytes& raw) {
    WireWriter tensor;
    for (const std::int64_t dimension : dimensions) {
        tensor.number(1, static_cast<std::uint64_t>(dimension));
    }
    return tensor.number(2, type).text(8, name).bytes(9, raw);
}
inline WireWriter floatTensor(std::string_view name, const Dimensions& dimensions, const std::vector<float>& values) {
    return rawTensor(name, onnxFloat, dimensions, bytesOf(values));
}
inline WireWriter integerTensor(std::string_view name, const std::vector<std::int64_t>& values) {
    Bytes raw(values.size() * sizeof(std::int64_t));
    for (std::size_t index = 0; index < values.size(); ++index) {
        writeUnsigned(raw, index * sizeof(std::int64_t), sizeof(std::int64_t),
                      static_cast<std::uint64_t>(values[index]));
    }
    return rawTensor(name, onnxInt64, {static_cast<std::int64_t>(values.size())}, raw);
}

/// Builds an ONNX graph; `model` returns the complete file.
class OnnxWriter {
public:
    /// Adds a float input with a free batch dimension followed by these dimensions.
    OnnxWriter& input(std::string_view name, const Dimensions& behindBatch) {
        graph.message(11, value(name, behindBatch));
        return *this;
    }
    OnnxWriter& output(std::string_view name, const Dimensions& behindBatch) {
        graph.message(12, value(name, behindBatch));
        return *this;
    }
    OnnxWriter& constant(const WireWriter& tensor) {
        graph.message(5, tensor);
        return *this;
    }
    OnnxWriter& apply(std::string_view type, const Names& inputs, const Names& outputs,
                      std::initializer_list<WireWriter> attributes = {}, std::string_view domain = "") {
        WireWriter node;
        for (const std::string& name : inputs) {
            node.text(1, name);
        }
        for (const std::string& name : outputs) {
            node.text(2, name);
        }
        node.text(4, type);
        for (const WireWriter& attribute : attributes) {
            node.message(5, attribute);
        }
        if (!domain.empty()) {
            node.text(7, domain);
        }
        graph.message(1, node);
        return *this;
    }
    /// The complete file; `opset` is a field of ModelProto.
    [[nodiscard]] WireWriter model(std::uint64_t opset = 16, std::string_view domain = "") const {
        return WireWriter().number(1, 8).message(7, graph).message(8, opsetOf(opset, domain));
    }
    static WireWriter opsetOf(std::uint64_t opset, std::string_view domain) {
        return WireWriter().text(1, domain).number(2, opset);
    }

    WireWriter graph = WireWriter().text(2, "made by a test");

private:
    static WireWriter value(std::string_view name, const Dimensions& behindBatch) {
        WireWriter shape;
        shape.message(1, WireWriter().text(2, "B"));
        for (const std::int64_t dimension : behindBatch) {
            shape.message(1, WireWriter().number(1, static_cast<std::uint64_t>(dimension)));
        }
        const WireWriter tensor = WireWriter().number(1, onnxFloat).message(2, shape);
        return WireWriter().text(1, name).message(2, WireWriter().message(1, tensor));
    }
};

/// A level graph, log_level = motion * weights, that tests extend by further operators. `last` is the operator that
/// computes log_level.
inline OnnxWriter levelGraph() {
    OnnxWriter writer;
    writer.input("motion", {3}).output("log_level", {1});
    writer.constant(floatTensor("weights", {3, 1}, {0.4F, 0.3F, 0.2F}));
    return writer.apply("MatMul", {"motion", "weights"}, {"weighted"});
}

/// A level graph that loops so often that it would never end.
inline Bytes loopingLevel() {
    OnnxWriter body;
    body.apply("Identity", {"go"}, {"goes"}).apply("Add", {"x", "x"}, {"y"});
    OnnxWriter writer = levelGraph();
    writer.constant(integerTensor("count", {std::int64_t{1} << 62}));
    return writer.apply("Loop", {"count", "", "weighted"}, {"log_level"}, {graphAttribute("body", body.graph)})
        .model()
        .written();
}

/// A level graph of a few kilobytes with allowed operators only, which multiplies matrices of 1000 rows 1000 times:
/// half a minute on a fast machine.
inline Bytes slowLevel() {
    OnnxWriter writer = levelGraph();
    writer.constant(integerTensor("size", {1000, 1000}));
    writer.apply("ConstantOfShape", {"size"}, {"zeros"})
        .apply("ReduceMean", {"weighted"}, {"mean"}, {integerAttribute("keepdims", 0)});
    writer.apply("Add", {"zeros", "mean"}, {"product 0"});
    for (int step = 0; step < 1000; ++step) {
        writer.apply("MatMul", {"product " + std::to_string(step), "zeros"}, {"product " + std::to_string(step + 1)});
    }
    writer.apply("ReduceMean", {"product 1000"}, {"nothing"}, {integerAttribute("keepdims", 0)});
    return writer.apply("Add", {"weighted", "nothing"}, {"log_level"}).model().written();
}

}  // namespace haptoflow::model::testing
