#include "model/model_tensors.hpp"

#include "model/model_error.hpp"

#include <bit>
#include <cmath>
#include <string>

namespace haptoflow::model {
namespace {

constexpr double seedRmsTolerance = 0.01;

float readFloat(std::span<const std::byte> bytes) {
    std::uint32_t bits = 0;
    for (std::size_t index = sizeof(float); index > 0; --index) {
        bits = (bits << 8U) | std::to_integer<std::uint32_t>(bytes[index - 1]);
    }
    return std::bit_cast<float>(bits);
}

double rmsOf(std::span<const float> samples) {
    double sumOfSquares = 0.0;
    for (const float value : samples) {
        sumOfSquares += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(sumOfSquares / static_cast<double>(samples.size()));
}

}  // namespace

std::vector<float> readTensor(std::span<const std::byte> file, const Blob& blob) {
    const auto bytes = file.subspan(blob.offset, blob.bytes);
    std::vector<float> values(blob.bytes / sizeof(float));
    for (std::size_t index = 0; index < values.size(); ++index) {
        values[index] = readFloat(bytes.subspan(index * sizeof(float), sizeof(float)));
        // In this form the condition is also true for NaN.
        if (!(std::fabs(values[index]) <= maximumMagnitude)) {
            throw ModelError(ModelStatus::inconsistent, "tensor \"" + blob.name + "\": number " +
                                                            std::to_string(index) +
                                                            " is not finite or above 1e6 in magnitude");
        }
    }
    return values;
}

bool isUnitRms(std::span<const float> samples) {
    return std::fabs(rmsOf(samples) - 1.0) <= seedRmsTolerance;
}

void checkSeedRows(std::span<const float> seeds) {
    for (std::size_t row = 0; row < seeds.size() / seedSamples; ++row) {
        const auto seed = seeds.subspan(row * seedSamples, seedSamples);
        if (!isUnitRms(seed)) {
            throw ModelError(ModelStatus::inconsistent, "seed " + std::to_string(row) + " has an RMS of " +
                                                            std::to_string(rmsOf(seed)) + "; expected 1 within 1 %");
        }
    }
}

}  // namespace haptoflow::model
