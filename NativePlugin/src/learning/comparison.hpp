#pragma once

#include "learning/learning_report.hpp"
#include "learning/texture_figures.hpp"
#include "learning/tone_fit.hpp"

#include <cstddef>
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

/// Ranges of force with enough sliding in each: one to three, as many as the recording tells apart.
struct ForceRanges {
    /// Boundaries between neighbours, increasing: one fewer than ranges.
    std::vector<double> edgesNewtons;
    /// Geometric mean of the frames' forces.
    std::vector<double> meansNewtons;

    [[nodiscard]] std::size_t rangeOf(double forceNewtons) const;
    [[nodiscard]] static ForceRanges divide(std::span<const SpectrumFrame> recorded);
};

/// The speeds at which laws of level are compared: from 5 mm/s to 1 m/s, in m/s.
[[nodiscard]] std::vector<double> lawSpeedsMps();

/// Recording, material and nearest label beside each other in each range of force and of speed, without their laws.
[[nodiscard]] std::vector<ForceComparison> comparedByForce(const SpeedBins& bins, const ForceRanges& ranges,
                                                           const ComparedFrames& recorded, const ComparedFrames& learnt,
                                                           const ComparedFrames& nearestLabel);

/// How much louder a tone makes a wave of unit level, as an RMS ratio, for the spectrum that the generated frames have
/// at the nearest speeds.
class ToneLevel {
public:
    ToneLevel(const SpeedBins& bins, std::span<const SpectrumFrame> generated, const model::ToneTable& tone);

    [[nodiscard]] double at(double speedMps, double forceNewtons) const;

private:
    EngineTone tone_;
    std::vector<double> speedsMps_;
    std::vector<MeanSpectrum> spectra_;
};

}  // namespace haptoflow::learning
