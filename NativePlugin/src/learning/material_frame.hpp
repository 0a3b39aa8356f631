#pragma once

#include "inference/segment_generator.hpp"
#include "learning/wave_vectors.hpp"
#include "recordings/prepared_recording.hpp"

#include <array>
#include <span>

namespace haptoflow::learning {

/// Rotation of a material's frame relative to its recording. A surface may be recorded at any angle, but a ruled
/// material's first axis is perpendicular to its most distinct ribs, as in the labels that the networks were trained
/// on. Without ribs the frame is that of the recording.
struct MaterialFrame {
    /// Angle from the recording's first axis to the material's.
    double turnRadians = 0.0;
    /// k1x, k1y, k2x, k2y in cycles per millimetre in the material's frame, 0 for none.
    std::array<float, 2 * inference::ribCount> waveNumbers{};

    /// Up to two vectors in the recording's frame, the most distinct first; zero vectors are skipped.
    [[nodiscard]] static MaterialFrame across(std::span<const WaveVector> vectors);

    /// Rotates the recording's motion into the material's frame.
    void turn(recordings::PreparedRecording& recording) const;
};

}  // namespace haptoflow::learning
