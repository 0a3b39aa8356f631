#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// The parts of an ONNX TensorProto that are checked before a runtime reads it.
struct OnnxTensor {
    std::string_view name;
    /// Empty if the content fits the dimensions; otherwise a sentence's predicate, with the tensor as its subject.
    std::string problem;
};

/// Parses a TensorProto; its numbers are counted but not read. Throws WireError.
[[nodiscard]] OnnxTensor readOnnxTensor(std::span<const std::byte> bytes);

}  // namespace haptoflow::model
