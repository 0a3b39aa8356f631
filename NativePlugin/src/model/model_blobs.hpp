#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::model {

/// One element of the header's "blobs", checked by itself: type, shape, and that shape and bytes agree.
/// Throws ModelError.
[[nodiscard]] Blob readBlob(const HeaderNode& node);

/// Checks that the blobs lie inside `file` behind `headerEnd`, do not overlap, match their checksums, and that
/// every byte outside them is zero. Throws ModelError.
void checkBlobBytes(std::span<const std::byte> file, std::size_t headerEnd, const std::vector<Blob>& blobs);

}  // namespace haptoflow::model
