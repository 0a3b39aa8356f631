#pragma once

#include "model/header_node.hpp"
#include "model/model_header.hpp"

#include <cstddef>

namespace haptoflow::model {

/// One element of the header's "labels"; its embedding row must be below `embeddingRows`. Throws ModelError.
[[nodiscard]] Label readLabel(const HeaderNode& node, std::size_t embeddingRows);

}  // namespace haptoflow::model
