#pragma once

#include "haptoflow/haptoflow.h"

#include "learning/made_recording.hpp"

namespace haptoflow::capi::testing {

/// Options for learning from a generated recording, which must outlive them.
inline haptoflow_learning_options optionsOf(const learning::testing::MadeRecording& made,
                                            const haptoflow_runtime* runtime, const haptoflow_model* model) {
    haptoflow_learning_options options{};
    options.struct_size = sizeof(options);
    options.axis_count = 1;
    options.runtime = runtime;
    options.model = model;
    options.name = "made surface";
    options.acceleration_mps2 = made.acceleration.data();
    options.sample_count = made.acceleration.size();
    options.sample_rate_hz = 4000.0;
    options.velocity_mps = made.velocity.data();
    options.force_newtons = made.force.data();
    options.seed = 1;
    return options;
}

}  // namespace haptoflow::capi::testing
