#pragma once

#include "learning/texture_figures.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// What makes the network's spectrum the recording's.
struct Tone {
    /// 1 to 8, rising.
    std::vector<double> speedsMps;
    std::vector<double> frequenciesHz;
    /// For each speed the gain at each frequency.
    std::vector<std::vector<double>> gainsDb;

    /// Straight lines in log speed between the rows and in log frequency within a row; held at the ends.
    [[nodiscard]] double gainDb(double speedMps, double frequencyHz) const;
};

struct ToneFit {
    Tone tone;
    /// For each speed of the tone: natural logarithm of the recording's RMS over that of the network's wave, both of
    /// unit level, behind a tone that leaves the network's RMS alone.
    std::vector<double> logLevels;
};

/// The ratio of the spectra in bands of about a third of an octave. Where frames are few the rows are drawn to their
/// mean, as far as chance explains what they are away from it. Above `bandwidthHz` the last gain holds.
[[nodiscard]] ToneFit fitTone(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                              std::span<const TextureFigures> generated, double bandwidthHz);

}  // namespace haptoflow::learning
