#pragma once

#include "learning/texture_figures.hpp"
#include "model/material_tables.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

struct ToneFit {
    /// What makes the network's spectrum the recording's; without speeds where there is nothing to tell.
    model::ToneTable tone;
    /// For each speed of the tone: natural logarithm of the recording's RMS over that of the network's wave, both of
    /// unit level, behind a tone that leaves the network's RMS alone.
    std::vector<double> logLevels;
};

/// The ratio of the spectra in bands of about a third of an octave. Where frames are few the rows are drawn to their
/// mean, as far as chance explains what they are away from it. Above `bandwidthHz` the last gain holds.
[[nodiscard]] ToneFit fitTone(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                              std::span<const TextureFigures> generated, double bandwidthHz);

}  // namespace haptoflow::learning
