#pragma once

#include "learning/texture_figures.hpp"
#include "model/material_tables.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// The filter from the network's spectrum to the recording's, level included, over speed and force. Without speeds if
/// there is not enough data.
///
/// The logarithm of the ratio is a sum of cosines over a warped frequency, whose weights are smooth functions of speed
/// and force, fitted by Whittle's likelihood of the recording's frames with a prior towards no tone. The strength of
/// the prior is the one with which the fit to three quarters of the recording explains the last quarter best, so that
/// chance in few frames is not taken for a tone. Above `bandwidthHz` the gain is that of the highest frequency below
/// it.
///
/// Level and shape come from `steady`, frames of the network in the conditions of the table (toneConditions), whose
/// corners a recording hardly visits. With `alongMotion`, frames of motions like the recorded ones, the shape comes
/// from those: the lines of ribs follow the speed, so that they lie where the recording's do only along its own motion.
[[nodiscard]] model::ToneTable fitTone(std::span<const SpectrumFrame> recorded, std::span<const SpectrumFrame> steady,
                                       std::optional<std::span<const SpectrumFrame>> alongMotion, double bandwidthHz);

/// The speeds in m/s and the forces in N of the tone that fits these frames.
struct ToneConditions {
    std::vector<double> speedsMps;
    std::vector<double> forcesNewtons;
};
[[nodiscard]] ToneConditions toneConditions(std::span<const SpectrumFrame> recorded);

/// The mean of the frames of one range of speed.
struct MeanSpectrum {
    double frames = 0.0;
    std::array<double, spectrumBins> power{};

    /// Sum over the bins: the mean square.
    [[nodiscard]] double whole() const;
};

/// The mean of each range of speed. `levels` (one for each frame, in m/s^2) make acceleration of frames of unit level;
/// empty leaves them as they are. Frames are filtered as the engine filters them with `tone`; null for none.
[[nodiscard]] std::vector<MeanSpectrum> meanSpectra(const SpeedBins& bins, std::span<const SpectrumFrame> frames,
                                                    std::span<const double> levels, const model::ToneTable* tone);

/// How far the network with a tone is from the recording, in dB.
struct ToneErrors {
    /// Root mean square difference of the mean spectra, 20 to 450 Hz, over the speeds.
    double spectralDistanceDb = 0.0;
    /// Maximum error of the power over the speeds, with its sign: below 0 the network is too quiet.
    double levelErrorDb = 0.0;
};
[[nodiscard]] ToneErrors toneErrors(const SpeedBins& bins, std::span<const SpectrumFrame> recorded,
                                    std::span<const SpectrumFrame> generated, const model::ToneTable& tone);

}  // namespace haptoflow::learning
