#pragma once

#include "model/model_builder.hpp"
#include "model/model_file.hpp"

namespace haptoflow::engine::testing {

/// A small model for tests of the engine, with labels, ranges and seeds but without runnable graphs. Range: 0.01-0.4
/// m/s, 0.1-4 N; labels "oak" and "metal mesh".
inline model::ModelFile smallModel() {
    return model::ModelFile::parse(model::testing::ModelBuilder{}.build());
}

}  // namespace haptoflow::engine::testing
