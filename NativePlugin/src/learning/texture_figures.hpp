#pragma once

#include "dsp/tone_filter.hpp"
#include "inference/prepared_tone.hpp"
#include "inference/segment_generator.hpp"
#include "model/material_tables.hpp"

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// Intervals of the recorded range of speed, on a logarithmic scale, with enough sliding in each.
struct SpeedBins {
    /// Boundaries between neighbouring bins, increasing: one fewer than bins.
    std::vector<double> edgesMps;
    /// Geometric mean of each bin's speeds.
    std::vector<double> centresMps;

    [[nodiscard]] std::size_t count() const { return centresMps.size(); }
    [[nodiscard]] std::size_t binOf(double speedMps) const;
    /// Divides the range into at most `most` bins, each with enough sliding for a spectrum and wide enough to matter.
    /// `speedsMps` has one entry for each sliding sample.
    [[nodiscard]] static SpeedBins divide(std::vector<double> speedsMps, std::size_t most);
};

/// Decibels per unit of the natural logarithm of an amplitude.
inline constexpr double decibelsPerNat = 8.685889638065037;
inline constexpr std::size_t spectrumSamples = 256;
inline constexpr std::size_t spectrumBins = spectrumSamples / 2 + 1;
inline constexpr double hertzPerBin = inference::waveformRateHz / static_cast<double>(spectrumSamples);
inline constexpr std::size_t envelopeFigures = 7;
inline constexpr std::size_t partialsOfRib = 6;
inline constexpr std::size_t ribPartials = partialsOfRib * inference::ribCount;

/// Phase along each wave vector since the start, in cycles.
using RibTravel = std::array<double, inference::ribCount>;

/// Power density of a Hann-windowed frame; its sum over a long wave's frames is in the mean the wave's mean square.
[[nodiscard]] std::array<double, spectrumBins> powerOf(std::span<const float, spectrumSamples> wave);

/// The power of one frame of unit level and the motion in it.
struct SpectrumFrame {
    double speedMps = 0.0;
    double forceNewtons = 0.0;
    std::array<double, spectrumBins> power{};
    /// Sample of the recording at which the frame begins, and its wave.
    std::size_t first = 0;
    std::array<float, spectrumSamples> wave{};
};

/// Statistics of a texture of unit level at one speed.
struct TextureFigures {
    double frames = 0.0;
    /// Mean power density over Hann-windowed frames of 128 ms; its mean is the wave's mean square.
    std::array<double, spectrumBins> power{};
    /// Statistics of the envelope: mean and standard deviation of the log RMS of 4, 20 and 60 samples; log kurtosis /
    /// 4.
    std::array<double, envelopeFigures> envelope{};
    double meanSquare = 0.0;
    /// Mean of the log kurtosis of each frame: impulses, without what changes from frame to frame.
    double logKurtosis = 0.0;
    /// Mean power of each partial of the ribs, those of the first wave vector first, and the number of frames in which
    /// it was below the end of the band.
    std::array<double, ribPartials> lines{};
    std::array<double, ribPartials> lineFrames{};
};

/// Accumulates the statistics of many stretches.
class TextureMeter {
public:
    explicit TextureMeter(std::size_t bins);

    /// Adds one stretch of `spectrumSamples` with a speed in `bin`. `ways` has an entry for each sample; empty without
    /// ribs.
    void add(std::size_t bin, std::span<const float, spectrumSamples> wave, std::span<const RibTravel> ribTravels);
    [[nodiscard]] std::vector<TextureFigures> figures() const;

private:
    struct Sums {
        double frames = 0.0;
        double samples = 0.0;
        std::array<double, spectrumBins> power{};
        double squares = 0.0;
        double fourths = 0.0;
        double logKurtoses = 0.0;
        std::array<double, 3> pieces{};
        std::array<double, 3> logs{};
        std::array<double, 3> logSquares{};
        std::array<double, ribPartials> lines{};
        std::array<double, ribPartials> lineFrames{};
    };

    void addLines(Sums& sums, std::span<const float, spectrumSamples> wave,
                  std::span<const RibTravel> ribTravels) const;

    std::vector<Sums> sums_;
};

/// The mean over the speeds of distance(recorded, generated), weighted by the recording's frames. Speeds without
/// generated frames do not count.
template <typename Distance>
[[nodiscard]] double meanOverSpeeds(std::span<const TextureFigures> recorded, std::span<const TextureFigures> generated,
                                    Distance distance) {
    double total = 0.0;
    double weights = 0.0;
    for (std::size_t bin = 0; bin < recorded.size(); ++bin) {
        if (recorded[bin].frames > 0.0 && generated[bin].frames > 0.0) {
            total += recorded[bin].frames * distance(recorded[bin], generated[bin]);
            weights += recorded[bin].frames;
        }
    }
    return weights > 0.0 ? total / weights : 0.0;
}

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
