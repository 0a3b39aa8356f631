#pragma once

#include "haptoflow/haptoflow.h"

#include "learning/made_recording.hpp"

#include <gtest/gtest.h>

namespace haptoflow::capi::testing {

/// A generated recording's samples, which must outlive the info.
inline haptoflow_recording_info infoOf(const learning::testing::MadeRecording& made) {
    haptoflow_recording_info info{};
    info.struct_size = sizeof(info);
    info.axis_count = 1;
    info.sample_rate_hz = 4000.0;
    info.sample_count = made.acceleration.size();
    info.acceleration_mps2 = made.acceleration.data();
    info.velocity_mps = made.velocity.data();
    info.force_newtons = made.force.data();
    info.material_name = "made surface";
    return info;
}

/// An open recording of generated samples.
class MadeHandle {
public:
    explicit MadeHandle(const haptoflow_recording_info& info) {
        EXPECT_EQ(haptoflow_recording_create(&info, &recording), HAPTOFLOW_OK) << haptoflow_last_message();
    }
    ~MadeHandle() { EXPECT_EQ(haptoflow_recording_close(&recording), HAPTOFLOW_OK); }
    MadeHandle(const MadeHandle&) = delete;
    MadeHandle& operator=(const MadeHandle&) = delete;
    MadeHandle(MadeHandle&&) = delete;
    MadeHandle& operator=(MadeHandle&&) = delete;

    haptoflow_recording* recording = nullptr;
};

inline haptoflow_learning_options optionsOf(const haptoflow_recording* recording, const haptoflow_runtime* runtime,
                                            const haptoflow_model* model) {
    haptoflow_learning_options options{};
    options.struct_size = sizeof(options);
    options.recording = recording;
    options.runtime = runtime;
    options.model = model;
    options.seed = 1;
    return options;
}

}  // namespace haptoflow::capi::testing
