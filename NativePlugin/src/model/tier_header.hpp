#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"
#include "model/name_index.hpp"

#include <vector>

namespace haptoflow::model {

/// One element of the header's "tiers"; the graphs that it names must be ONNX blobs. Throws ModelError.
[[nodiscard]] Tier readTier(const HeaderNode& node, const NameIndex& blobNames, const std::vector<Blob>& blobs);

}  // namespace haptoflow::model
