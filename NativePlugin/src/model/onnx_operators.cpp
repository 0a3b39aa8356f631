#include "model/onnx_operators.hpp"

#include <algorithm>
#include <array>

namespace haptoflow::model {
namespace {

// In the order of their letters, for the search below.
constexpr std::array<std::string_view, 81> allowedOperators = {"Abs",         "Add",
                                                               "And",         "Atan",
                                                               "AveragePool", "BatchNormalization",
                                                               "Cast",        "Ceil",
                                                               "Clip",        "Concat",
                                                               "Constant",    "ConstantOfShape",
                                                               "Conv",        "ConvTranspose",
                                                               "Cos",         "Div",
                                                               "Elu",         "Equal",
                                                               "Erf",         "Exp",
                                                               "Expand",      "Flatten",
                                                               "Floor",       "GRU",
                                                               "Gather",      "GatherElements",
                                                               "Gemm",        "GlobalAveragePool",
                                                               "Greater",     "GreaterOrEqual",
                                                               "HardSigmoid", "HardSwish",
                                                               "Identity",    "InstanceNormalization",
                                                               "LSTM",        "LeakyRelu",
                                                               "Less",        "LessOrEqual",
                                                               "Log",         "LogSoftmax",
                                                               "MatMul",      "Max",
                                                               "MaxPool",     "Mean",
                                                               "Min",         "Mul",
                                                               "Neg",         "Not",
                                                               "Or",          "PRelu",
                                                               "Pad",         "Pow",
                                                               "Reciprocal",  "ReduceL1",
                                                               "ReduceL2",    "ReduceMax",
                                                               "ReduceMean",  "ReduceMin",
                                                               "ReduceSum",   "ReduceSumSquare",
                                                               "Relu",        "Reshape",
                                                               "Round",       "Selu",
                                                               "Shape",       "Sigmoid",
                                                               "Sign",        "Sin",
                                                               "Slice",       "Softmax",
                                                               "Softplus",    "Softsign",
                                                               "Split",       "Sqrt",
                                                               "Squeeze",     "Sub",
                                                               "Sum",         "Tanh",
                                                               "Transpose",   "Unsqueeze",
                                                               "Where"};
static_assert(std::ranges::is_sorted(allowedOperators));

}  // namespace

bool isAllowedOperator(std::string_view name) noexcept {
    return std::ranges::binary_search(allowedOperators, name);
}

std::size_t allowedOperatorCount() noexcept {
    return allowedOperators.size();
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
