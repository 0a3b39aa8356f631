#pragma once

#include "inference/segment_generator.hpp"
#include "learning/prepared_recording.hpp"
#include "learning/wave_vectors.hpp"

#include <array>
#include <span>

namespace haptoflow::learning {

/// How a material lies to its recording. A surface may lie under its recorder at any angle: a ruled material's first
/// axis is put across its clearest ribs, as in the labels that the networks know; without ribs the frame is that of the
/// recording. Training does the same (fewshot/stroke_recording.py).
struct MaterialFrame {
    /// From the recording's first axis to the material's.
    double turnRadians = 0.0;
    /// k1x, k1y, k2x, k2y in cycles per millimetre in the material's frame, 0 for none.
    std::array<float, 2 * inference::ribCount> waveNumbers{};

    /// Up to two vectors in the recording's frame, the clearest first; those that are zero are passed over.
    [[nodiscard]] static MaterialFrame across(std::span<const WaveVector> vectors);

    /// The recording's motion becomes one along the material's axes.
    void turn(PreparedRecording& recording) const;
};

}  // namespace haptoflow::learning
