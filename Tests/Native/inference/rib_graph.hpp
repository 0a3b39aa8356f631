#pragma once

#include "../model/onnx_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace haptoflow::inference::testing {

/// Output of the graph below per turn along the two wave vectors.
inline constexpr float firstRibWeight = 0.5F;
inline constexpr float secondRibWeight = -0.25F;

/// A field graph with the single input `phases`. Every element of its output point has the value first phase *
/// firstRibWeight + second phase * secondRibWeight.
inline model::testing::Bytes ribField(std::string_view output, const model::testing::Dimensions& shape) {
    using namespace model::testing;
    constexpr std::size_t phases = 6;
    std::size_t size = 1;
    Dimensions reshaped{-1};
    for (const std::int64_t dimension : shape) {
        size *= static_cast<std::size_t>(dimension);
        reshaped.push_back(dimension);
    }
    std::vector<float> weights(phases * size);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        weights[i] = i < size ? firstRibWeight : i < 2 * size ? secondRibWeight : 0.0F;
    }
    OnnxWriter writer;
    writer.input("phases", {static_cast<std::int64_t>(phases)}).output(output, shape);
    writer.constant(
        floatTensor("weights", {static_cast<std::int64_t>(phases), static_cast<std::int64_t>(size)}, weights));
    writer.constant(integerTensor("shape", reshaped));
    writer.apply("MatMul", {"phases", "weights"}, {"flat"});
    return writer.apply("Reshape", {"flat", "shape"}, {std::string(output)}).model().written();
}

}  // namespace haptoflow::inference::testing
