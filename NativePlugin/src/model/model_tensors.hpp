#pragma once

#include "model/model_header.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::model {

/// The numbers of a float32 blob of `file`. Throws ModelError (inconsistent) if one is not finite or has a magnitude
/// above 1e6.
[[nodiscard]] std::vector<float> readTensor(std::span<const std::byte> file, const Blob& blob);

/// True if the RMS of `samples` is 1 within 1 %.
[[nodiscard]] bool isUnitRms(std::span<const float> samples);

/// Checks that every row of seedSamples numbers has an RMS of 1 within 1 %. Throws ModelError (inconsistent).
void checkSeedRows(std::span<const float> seeds);

}  // namespace haptoflow::model
