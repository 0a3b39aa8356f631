#pragma once

#include "learning/texture_figures.hpp"
#include "model/material_tables.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

struct ToneFit {
    /// The filter from the network's spectrum to the recording's; without speeds if there is not enough data.
    model::ToneTable tone;
    /// For each speed of the tone, the natural logarithm of the recording's RMS divided by that of the network's wave,
    /// both of unit level, after a tone that keeps the network's RMS.
    std::vector<double> logLevels;

    /// Interpolated over the log speed; constant beyond the tone's speeds, of which there is at least one.
    [[nodiscard]] double logLevel(double speedMps) const;
};

/// The ratio of the spectra in bands of about a third of an octave. Rows with few frames are shrunk towards their mean,
/// as far as chance explains their differences. Above `bandwidthHz` the last gain is used.
[[nodiscard]] ToneFit fitTone(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                              std::span<const TextureFigures> generated, double bandwidthHz);

/// Root mean square difference in dB of the mean spectra, 20 to 450 Hz, over the speeds, behind the tone.
[[nodiscard]] double spectralDistanceDb(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                                        std::span<const TextureFigures> generated, const ToneFit& fit);

}  // namespace haptoflow::learning
