#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::model {

/// Reads one element of the header's "blobs" and checks it by itself: its type, its shape, and that shape and length
/// agree. Throws ModelError.
[[nodiscard]] Blob readBlob(const HeaderNode& node);

/// Checks that the blobs lie inside `file` after `headerEnd`, do not overlap and match their checksums, and that every
/// byte outside them is zero. Throws ModelError.
void checkBlobBytes(std::span<const std::byte> file, std::size_t headerEnd, const std::vector<Blob>& blobs);

/// The numbers of a float32 blob of `file`. Throws ModelError (inconsistent) if one is not finite or has a magnitude
/// above 1e6.
[[nodiscard]] std::vector<float> readTensor(std::span<const std::byte> file, const Blob& blob);

/// True if the RMS of `samples` is 1 within 1 %.
[[nodiscard]] bool isUnitRms(std::span<const float> samples);

/// Checks that every row of seedSamples numbers has an RMS of 1 within 1 %. Throws ModelError (inconsistent).
void checkSeedRows(std::span<const float> seeds);

}  // namespace haptoflow::model
