#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// Parts of the recorded range of speed, divided by logarithm where there is as much sliding on either side.
struct SpeedBins {
    /// Between neighbouring bins, rising: one fewer than there are bins.
    std::vector<double> edgesMps;
    /// Geometric mean of each bin's speeds.
    std::vector<double> centresMps;

    [[nodiscard]] std::size_t count() const { return centresMps.size(); }
    [[nodiscard]] std::size_t binOf(double speedMps) const;
    /// At most `most`, with enough sliding in each for a spectrum and none too narrow to matter. `speedsMps`: one for
    /// each sliding sample.
    [[nodiscard]] static SpeedBins divide(std::vector<double> speedsMps, std::size_t most);
};

inline constexpr std::size_t spectrumSamples = 256;
inline constexpr std::size_t spectrumBins = spectrumSamples / 2 + 1;
inline constexpr double hertzPerBin = inference::waveformRateHz / static_cast<double>(spectrumSamples);
inline constexpr std::size_t envelopeFigures = 7;
inline constexpr std::size_t partialsOfRib = 6;
inline constexpr std::size_t ribPartials = partialsOfRib * inference::ribCount;

/// How far a tip has travelled along each wave vector, in turns.
using RibWay = std::array<double, inference::ribCount>;

/// What a texture of unit level is like at one speed.
struct TextureFigures {
    double frames = 0.0;
    /// Mean power density over Hann-windowed frames of 128 ms: their mean is the wave's mean square.
    std::array<double, spectrumBins> power{};
    /// How its strength changes in time: mean and spread of the log RMS of 4, 20 and 60 samples; log kurtosis / 4.
    std::array<double, envelopeFigures> envelope{};
    double meanSquare = 0.0;
    /// Mean power of each partial of the ribs, those of the first wave vector first, and in how many frames it was one
    /// that a wave at 2 kHz can show.
    std::array<double, ribPartials> lines{};
    std::array<double, ribPartials> lineFrames{};
};

/// Gathers the figures of many stretches.
class TextureMeter {
public:
    explicit TextureMeter(std::size_t bins);

    /// One stretch of `spectrumSamples`; its speed belongs to `bin`. `ways`: for each sample; empty without ribs.
    void add(std::size_t bin, std::span<const float, spectrumSamples> wave, std::span<const RibWay> ways);
    [[nodiscard]] std::vector<TextureFigures> figures() const;

private:
    struct Sums {
        double frames = 0.0;
        double samples = 0.0;
        std::array<double, spectrumBins> power{};
        double squares = 0.0;
        double fourths = 0.0;
        std::array<double, 3> pieces{};
        std::array<double, 3> logs{};
        std::array<double, 3> logSquares{};
        std::array<double, ribPartials> lines{};
        std::array<double, ribPartials> lineFrames{};
    };

    void addLines(Sums& sums, std::span<const float, spectrumSamples> wave, std::span<const RibWay> ways) const;

    void addSpectrum(Sums& sums, std::span<const float, spectrumSamples> wave) const;

    std::array<double, spectrumSamples> window_{};
    std::vector<Sums> sums_;
};

}  // namespace haptoflow::learning
