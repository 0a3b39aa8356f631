#pragma once

#include "learning/learning_report.hpp"
#include "learning/tone_fit.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// Frames of unit level with their levels in m/s^2, and the tone that they get. See `meanSpectra` and `momentsOf`.
struct ComparedFrames {
    std::span<const SpectrumFrame> frames;
    std::vector<double> levels;
    const model::ToneTable* tone = nullptr;
    std::vector<FrameMoments> moments;
};

/// Frequencies of the curves: six in each octave from 16 to 900 Hz.
[[nodiscard]] std::vector<double> comparedHz();

/// Recording, material and nearest label beside each other in each range of speed.
[[nodiscard]] std::vector<SpeedComparison> compared(const SpeedBins& bins, const ComparedFrames& recorded,
                                                    const ComparedFrames& learnt, const ComparedFrames& nearestLabel);

}  // namespace haptoflow::learning
