#pragma once

#include "learning/learning_report.hpp"
#include "learning/tone_fit.hpp"

#include <functional>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// Frames of unit level, and what makes acceleration of them. See `meanSpectra`.
struct ComparedFrames {
    std::span<const SpectrumFrame> frames;
    const model::ToneTable* tone = nullptr;
    /// Square of the level in (m/s^2)^2.
    std::function<double(const SpectrumFrame&)> powerOf;
};

/// Frequencies of the curves: about six an octave, from 16 to 900 Hz.
[[nodiscard]] std::vector<double> comparedHz();

/// Recording, material and nearest label beside each other in each range of speed.
[[nodiscard]] std::vector<SpeedComparison> compared(const SpeedBins& bins, const ComparedFrames& recorded,
                                                    const ComparedFrames& learnt, const ComparedFrames& nearestLabel);

}  // namespace haptoflow::learning
