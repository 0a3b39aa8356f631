#pragma once

#include "learning/made_recording.hpp"
#include "open_handles.hpp"

namespace haptoflow::capi::testing {

/// A generated recording's samples, which must outlive the info.
inline haptoflow_recording_info infoOf(const learning::testing::MadeRecording& made) {
    auto info = sized<haptoflow_recording_info>();
    info.axis_count = 1;
    info.sample_rate_hz = 4000.0;
    info.sample_count = made.acceleration.size();
    info.acceleration_mps2 = made.acceleration.data();
    info.velocity_mps = made.velocity.data();
    info.force_newtons = made.force.data();
    info.material_name = "made surface";
    return info;
}

inline haptoflow_recording* recordingOf(const haptoflow_recording_info& info) {
    haptoflow_recording* recording = nullptr;
    EXPECT_EQ(haptoflow_recording_create(&info, &recording), HAPTOFLOW_OK) << message();
    return recording;
}

inline haptoflow_learning_options learningOptions(const haptoflow_recording* recording,
                                                  const haptoflow_runtime* runtime, const haptoflow_model* model) {
    auto options = sized<haptoflow_learning_options>();
    options.recording = recording;
    options.runtime = runtime;
    options.model = model;
    options.seed = 1;
    return options;
}

}  // namespace haptoflow::capi::testing
