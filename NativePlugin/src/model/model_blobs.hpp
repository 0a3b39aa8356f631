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

}  // namespace haptoflow::model
