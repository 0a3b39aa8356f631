#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"
#include "model/name_index.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::model {

/// Reads the keys that labels and material files have in common: all of a label but its name and its embedding row.
/// Throws ModelError.
void readLabelTraits(const HeaderNode& node, Label& label);

/// Reads one element of the header's "labels"; its embedding row must be below `embeddingRows`. Throws ModelError.
[[nodiscard]] Label readLabel(const HeaderNode& node, std::size_t embeddingRows);

/// Reads the header's "skeleton". Throws ModelError.
[[nodiscard]] SkeletonHeader readSkeleton(const HeaderNode& node);

/// Reads one element of the header's "tiers"; the graphs that it names must be ONNX blobs. Throws ModelError.
[[nodiscard]] Tier readTier(const HeaderNode& node, const NameIndex& blobNames, const std::vector<Blob>& blobs);

}  // namespace haptoflow::model
