#pragma once

#include "learning/closed_loop.hpp"
#include "learning/sliding.hpp"
#include "learning/texture_figures.hpp"

#include <span>
#include <vector>

namespace haptoflow::learning {

/// Distance between generated and recorded statistics, in dB^2: third-octave spectra, level, envelope and ribs, with
/// speeds weighted by their share of the recording. Speeds without generated samples do not count.
[[nodiscard]] double textureDistance(std::span<const TextureFigures> recorded,
                                     std::span<const TextureFigures> generated, double bandwidthHz);

/// Compares embeddings by the waves that the network generates along the recording's own motion.
class TextureFit {
public:
    /// `unitWave`: the recording divided by its level. All arguments must outlive the fit.
    TextureFit(ClosedLoop& loop, const recordings::PreparedRecording& recording, const Sliding& sliding,
               std::span<const float> unitWave, std::span<const float, 2 * inference::ribCount> waveVectors,
               std::uint64_t seed);

    [[nodiscard]] const SpeedBins& bins() const noexcept { return bins_; }
    [[nodiscard]] std::span<const TextureFigures> recorded() const noexcept { return recorded_; }
    [[nodiscard]] std::span<const float> unitWave() const noexcept { return unitWave_; }
    /// For each sample of the recording; empty without ribs.
    [[nodiscard]] std::span<const RibTravel> ribTravels() const noexcept { return ribTravels_; }

    /// The distance of each embedding, all with the same noise, on `chains` stretches distributed over the speeds; each
    /// `round` uses other stretches.
    [[nodiscard]] std::vector<double> distances(std::span<const Embedding> embeddings, std::size_t chains,
                                                std::uint64_t round);

    /// The statistics at each speed of waves generated for an embedding with this factor on its impulses, always with
    /// the same noise.
    [[nodiscard]] std::vector<TextureFigures> figuresOf(const Embedding& embedding, float impulseGain);

    /// Frames of the recording in which the tip slides throughout. Each begins half a frame after the one before.
    [[nodiscard]] std::vector<SpectrumFrame> recordedFrames() const;
    /// Frames of waves generated for an embedding along the whole recording, several times, at 72 updates per second.
    [[nodiscard]] std::vector<SpectrumFrame> generatedFrames(const Embedding& embedding, float impulseGain);
    /// Frames of waves generated for an embedding at every combination of the given speeds and forces, in the
    /// directions that the recording has in similar conditions. Generates at most `segmentBudget` segments, but at
    /// least two waves in each condition.
    [[nodiscard]] std::vector<SpectrumFrame> steadyFrames(const Embedding& embedding, std::span<const double> speedsMps,
                                                          std::span<const double> forcesNewtons,
                                                          std::uint64_t segmentBudget, float impulseGain);

private:
    /// Stretches of the recording's motion, evenly distributed over each speed; `round` chooses others.
    [[nodiscard]] std::vector<Chain> chainsOf(std::size_t count, std::uint64_t round) const;
    /// Adds `count` chains with a steady motion in the directions of the recording's motions near this speed and force.
    void addSteadyChains(std::vector<Chain>& chains, double speedMps, double newtons, std::size_t count) const;
    [[nodiscard]] std::vector<std::vector<std::size_t>> startsByBin(std::size_t samples) const;
    void measure(TextureMeter& meter, std::span<const float> wave, std::size_t start) const;
    /// Adds the frames of a wave that begins at the recording's sample `start`.
    void addFrames(std::vector<SpectrumFrame>& frames, std::span<const float> wave, std::size_t start) const;
    /// Calls `use(place in the wave)` for each frame that slides.
    template <typename Use>
    void forEachFrame(std::size_t samples, std::size_t start, std::size_t hop, Use use) const;
    [[nodiscard]] double meanSpeedMps(std::size_t first) const;

    ClosedLoop& loop_;
    const recordings::PreparedRecording& recording_;
    const Sliding& sliding_;
    std::span<const float> unitWave_;
    std::vector<RibTravel> ribTravels_;
    std::uint64_t seed_;
    SpeedBins bins_;
    std::vector<TextureFigures> recorded_;
    std::vector<std::vector<std::size_t>> starts_;
};

}  // namespace haptoflow::learning
