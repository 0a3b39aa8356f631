#pragma once

#include "dsp/tone_filter.hpp"
#include "inference/prepared_tone.hpp"
#include "learning/texture_figures.hpp"
#include "model/material_tables.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// What a filter makes of each bin of a spectrum.
[[nodiscard]] std::array<std::complex<double>, spectrumBins> responseOf(const dsp::ToneKernel& kernel);

/// A tone as the engine filters with it.
class EngineTone {
public:
    /// Null or empty for none.
    explicit EngineTone(const model::ToneTable* tone);

    /// The middle half of a frame's samples, filtered.
    [[nodiscard]] std::array<double, spectrumSamples / 2> filtered(const SpectrumFrame& frame) const;
    /// Power ratio at each bin of a spectrum.
    [[nodiscard]] std::array<double, spectrumBins> powerGains(double speedMps, double forceNewtons) const;

private:
    [[nodiscard]] std::optional<dsp::ToneKernel> kernelAt(double speedMps, double forceNewtons) const;

    std::optional<inference::PreparedTone> tone_;
};

/// What one frame of unit level adds to the figures of its speed and force.
struct FrameMoments {
    double meanSquare = 0.0;
    double meanFourth = 0.0;
    /// Power of the partials of each rib; empty where the tip is too slow to tell them from the noise between them.
    std::array<std::optional<double>, inference::ribCount> ribs{};
};

/// The moments of each frame after the tone has filtered it. `ribTravels`: for each sample of the recording, from
/// `TextureFit::ribTravels`; empty where there are no ribs.
[[nodiscard]] std::vector<FrameMoments> momentsOf(std::span<const SpectrumFrame> frames, const model::ToneTable* tone,
                                                  std::span<const RibTravel> ribTravels);

/// Statistics of the frames of one range of speed and force.
struct WaveFigures {
    std::size_t frames = 0;
    /// 0 without frames.
    double rmsMps2 = 0.0;
    /// E[x^4] / E[x^2]^2 of the wave divided by its level: 3 for Gaussian noise, more with rare events. Empty without
    /// frames.
    std::optional<double> kurtosis;
    /// For each rib the share of the wave's power that its partials have, in dB and not below -40. Empty without ribs,
    /// and where the tip is too slow to tell partials from noise.
    std::array<std::optional<double>, inference::ribCount> ribsDb{};
};

/// The figures of the frames for which `belongs` is true. `levels`: one for each frame, in m/s^2.
[[nodiscard]] WaveFigures figuresOf(std::span<const FrameMoments> moments, std::span<const double> levels,
                                    const std::function<bool(std::size_t frame)>& belongs);

}  // namespace haptoflow::learning
