#pragma once

#include <cstddef>
#include <string_view>

namespace haptoflow::model {

/// The opset of every graph of a model file.
inline constexpr unsigned graphOpset = 16;

/// Whether a graph of a model file may use this operator of ONNX's own domain (Documentation~/model-format.md). All of
/// them give results whose size follows from their inputs' sizes and from constants, and none holds a graph of its own.
[[nodiscard]] bool isAllowedOperator(std::string_view name) noexcept;

/// How many they are.
[[nodiscard]] std::size_t allowedOperatorCount() noexcept;

/// Whether the input at this place says how large or of what shape the result is.
[[nodiscard]] bool isShapeOperand(std::string_view name, std::size_t input) noexcept;

}  // namespace haptoflow::model
