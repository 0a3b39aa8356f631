#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace haptoflow::model {

inline constexpr std::size_t maximumGraphNodes = 16'384;
inline constexpr std::size_t maximumGraphTensors = 65'536;

/// Checks the bytes of an ONNX model before a runtime loads them, by the rules of Documentation~/model-format.md: opset
/// 16 and no other domain; only allowed operators, so that no graph contains another; every tensor in the file itself
/// and of its stated size; every name defined before it is used; no size that depends on the content of the inputs.
/// Time and memory are linear in the number of bytes. Throws ModelError (inconsistent, or oversized for a count) with a
/// message that begins with `name` and contains the operator and the remedy.
void checkOnnxModel(std::span<const std::byte> bytes, const std::string& name);

}  // namespace haptoflow::model
