#pragma once

#include "learning/learning_report.hpp"
#include "learning/tone_fit.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// Frequencies of the curves: about six an octave, from 16 to 900 Hz.
[[nodiscard]] std::vector<double> comparedHz();

/// A curve for each range of speed; empty where it has no frames. Arguments as of `meanSpectra`.
[[nodiscard]] std::vector<SpeedComparison::Curve> curvesOf(const SpeedBins& bins, std::span<const SpectrumFrame> frames,
                                                           const model::ToneTable* tone,
                                                           const std::function<double(const SpectrumFrame&)>& powerOf);

}  // namespace haptoflow::learning
