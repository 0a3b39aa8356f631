#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace haptoflow::model {

/// The opset of every graph of a model file.
inline constexpr unsigned graphOpset = 16;
inline constexpr std::size_t maximumGraphNodes = 16'384;
inline constexpr std::size_t maximumGraphTensors = 65'536;

/// Every allowed operator of ONNX's own domain (Documentation~/model-format.md): arithmetic and functions element by
/// element, comparisons, layers, reductions, and what orders, shapes and types. The sizes of their results depend only
/// on the sizes of their inputs and on constants, and none of them contains a graph.
inline constexpr std::string_view allowedOperators =
    " Abs Add Ceil Clip Div Floor Max Mean Min Mul Neg Pow Reciprocal Round Sign Sqrt Sub Sum"
    " Atan Cos Elu Erf Exp HardSigmoid HardSwish LeakyRelu Log PRelu Relu Selu Sigmoid Sin Softplus Softsign Tanh"
    " And Equal Greater GreaterOrEqual Less LessOrEqual Not Or Where"
    " AveragePool BatchNormalization Conv ConvTranspose GRU Gemm GlobalAveragePool InstanceNormalization LSTM "
    "LogSoftmax"
    " MatMul MaxPool Softmax"
    " ReduceL1 ReduceL2 ReduceMax ReduceMean ReduceMin ReduceSum ReduceSumSquare"
    " Cast Concat Constant ConstantOfShape Expand Flatten Gather GatherElements Identity Pad Reshape Shape Slice Split"
    " Squeeze Transpose Unsqueeze ";

/// Checks the bytes of an ONNX model before a runtime loads them, by the rules of Documentation~/model-format.md: opset
/// 16 and no other domain; only allowed operators, so that no graph contains another; every tensor in the file itself
/// and of its stated size; every name defined before it is used; no size that depends on the content of the inputs.
/// Time and memory are linear in the number of bytes. Throws ModelError (inconsistent, or oversized for a count) with a
/// message that begins with `name` and contains the operator and the remedy.
void checkOnnxModel(std::span<const std::byte> bytes, const std::string& name);

}  // namespace haptoflow::model
