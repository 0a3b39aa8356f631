#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"

#include <cstddef>

namespace haptoflow::model {

/// Everything that labels and material files say in the same keys: all of a label but name and embedding row. Throws
/// ModelError.
void readLabelTraits(const HeaderNode& node, Label& label);

/// One element of the header's "labels"; its embedding row must be below `embeddingRows`. Throws ModelError.
[[nodiscard]] Label readLabel(const HeaderNode& node, std::size_t embeddingRows);

}  // namespace haptoflow::model
