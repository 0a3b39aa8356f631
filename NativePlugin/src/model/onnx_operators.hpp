#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace haptoflow::model {

/// The opset of every graph of a model file.
inline constexpr unsigned graphOpset = 16;

/// True if a graph of a model file may use this operator of ONNX's own domain (Documentation~/model-format.md). The
/// sizes of their results depend only on the sizes of their inputs and on constants, and none of them contains a graph.
[[nodiscard]] bool isAllowedOperator(std::string_view name) noexcept;

/// The names of all allowed operators.
[[nodiscard]] std::span<const std::string_view> allowedOperators() noexcept;

/// True if this input determines the size or shape of the operator's result.
[[nodiscard]] bool isShapeOperand(std::string_view name, std::size_t input) noexcept;

}  // namespace haptoflow::model
