#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace haptoflow::model {

inline constexpr std::size_t maximumGraphNodes = 16'384;
inline constexpr std::size_t maximumGraphTensors = 65'536;

/// Reads the bytes of an ONNX model before anybody runs them and checks the rules of Documentation~/model-format.md:
/// opset 16 and no other domain; operators of the list only, so that no graph holds another; every tensor in the file
/// itself and as large as it says; every name made before it is read; no size that depends on what the inputs hold.
/// Cost and memory grow linearly with the bytes. Throws ModelError (inconsistent, or oversized for a count) that begins
/// with `name` and names the operator and the remedy.
void checkOnnxModel(std::span<const std::byte> bytes, const std::string& name);

}  // namespace haptoflow::model
