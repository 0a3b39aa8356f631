#pragma once

#include "inference/segment_generator.hpp"
#include "learning/prepared_recording.hpp"
#include "learning/sliding.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// A family of ribs: what repeats with the way travelled.
struct WaveVector {
    /// Cycles per millimetre.
    double x = 0.0;
    double y = 0.0;
    /// Power of its line over that of noise as strong and of that spectrum.
    double prominence = 0.0;

    [[nodiscard]] double cyclesPerMillimetre() const;
};

/// At most two, the more prominent first: lines that keep their place in the way while the speed changes. None where
/// the speed is too even to tell a rib from a resonance. Where all strokes go one way, a vector along it.
[[nodiscard]] std::vector<WaveVector> findWaveVectors(const PreparedRecording& recording, const Sliding& sliding,
                                                      std::span<const float> unitWave);

}  // namespace haptoflow::learning
