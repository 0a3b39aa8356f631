#include "model/onnx_operators.hpp"

#include <algorithm>
#include <array>

namespace haptoflow::model {
namespace {

constexpr auto operatorNames = std::to_array<std::string_view>({
    // Arithmetic, element by element.
    "Abs",
    "Add",
    "Ceil",
    "Clip",
    "Div",
    "Floor",
    "Max",
    "Mean",
    "Min",
    "Mul",
    "Neg",
    "Pow",
    "Reciprocal",
    "Round",
    "Sign",
    "Sqrt",
    "Sub",
    "Sum",
    // Functions, element by element.
    "Atan",
    "Cos",
    "Elu",
    "Erf",
    "Exp",
    "HardSigmoid",
    "HardSwish",
    "LeakyRelu",
    "Log",
    "PRelu",
    "Relu",
    "Selu",
    "Sigmoid",
    "Sin",
    "Softplus",
    "Softsign",
    "Tanh",
    // Comparisons and selections.
    "And",
    "Equal",
    "Greater",
    "GreaterOrEqual",
    "Less",
    "LessOrEqual",
    "Not",
    "Or",
    "Where",
    // Layers.
    "AveragePool",
    "BatchNormalization",
    "Conv",
    "ConvTranspose",
    "GRU",
    "Gemm",
    "GlobalAveragePool",
    "InstanceNormalization",
    "LSTM",
    "LogSoftmax",
    "MatMul",
    "MaxPool",
    "Softmax",
    // Reductions.
    "ReduceL1",
    "ReduceL2",
    "ReduceMax",
    "ReduceMean",
    "ReduceMin",
    "ReduceSum",
    "ReduceSumSquare",
    // Order, shape and type.
    "Cast",
    "Concat",
    "Constant",
    "ConstantOfShape",
    "Expand",
    "Flatten",
    "Gather",
    "GatherElements",
    "Identity",
    "Pad",
    "Reshape",
    "Shape",
    "Slice",
    "Split",
    "Squeeze",
    "Transpose",
    "Unsqueeze",
});

}  // namespace

bool isAllowedOperator(std::string_view name) noexcept {
    return std::ranges::find(operatorNames, name) != operatorNames.end();
}

std::span<const std::string_view> allowedOperators() noexcept {
    return operatorNames;
}

bool isShapeOperand(std::string_view name, std::size_t input) noexcept {
    if (name == "ConstantOfShape") {
        return input == 0;
    }
    if (name == "Expand" || name == "Pad" || name == "Reshape") {
        return input == 1;
    }
    return name == "Slice" && input >= 1;
}

}  // namespace haptoflow::model
