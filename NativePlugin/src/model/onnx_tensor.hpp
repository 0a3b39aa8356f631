#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// A TensorProto of ONNX, as far as it must be known before a runtime reads it.
struct OnnxTensor {
    std::string_view name;
    /// Empty where the tensor holds what its dimensions promise; otherwise the rest of a sentence that begins with it.
    std::string problem;
};

/// Reads a TensorProto; its numbers are counted, not read. Throws WireError.
[[nodiscard]] OnnxTensor readOnnxTensor(std::span<const std::byte> bytes);

}  // namespace haptoflow::model
