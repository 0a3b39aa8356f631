#pragma once

#include "learning/made_recording.hpp"
#include "output_file.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace haptoflow::cli::testing {

/// The rate of generated recordings.
inline constexpr double recordingHz = 4000.0;

/// A generated recording as a table: time, acceleration, velocity of two axes, force.
inline std::string tableOf(
    const learning::testing::MadeRecording& made,
    const std::string& columns = "time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons") {
    std::ostringstream text;
    text << columns << '\n';
    for (std::size_t i = 0; i < made.acceleration.size(); ++i) {
        text << static_cast<double>(i) / recordingHz << ',' << made.acceleration[i] << ',' << made.velocity[2 * i]
             << ',' << made.velocity[2 * i + 1] << ',' << made.force[i] << '\n';
    }
    return text.str();
}

/// The acceleration of a generated recording as a WAV file, with an acceleration in m/s^2 at +-1.
inline void writeWav(const std::filesystem::path& file, const learning::testing::MadeRecording& made,
                     float fullScaleMps2) {
    std::vector<float> samples = made.acceleration;
    std::ranges::transform(samples, samples.begin(), [&](float value) { return value / fullScaleMps2; });
    WavWriter writer(file, static_cast<int>(recordingHz), file.string());
    writer.write(samples);
    writer.close();
}

}  // namespace haptoflow::cli::testing
