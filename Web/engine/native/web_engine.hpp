#pragma once

#include "haptoflow/haptoflow.h"

#include <nlohmann/json_fwd.hpp>

namespace haptoflow::web {

/// The one model of a module's memory. Throws WebError if none is open.
[[nodiscard]] haptoflow_model* theModel();
/// Throws WebError if it is closed.
[[nodiscard]] haptoflow_engine* theEngine();
/// Stands for the ONNX Runtime of the worker's scripts.
[[nodiscard]] haptoflow_runtime* theRuntime();

}  // namespace haptoflow::web
