#pragma once

#include "learning/closed_loop.hpp"
#include "learning/embedding_space.hpp"
#include "learning/rib_alignment.hpp"
#include "learning/sliding.hpp"
#include "learning/texture_figures.hpp"

#include <functional>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// How far generated figures are from recorded ones, in dB^2: third-octave spectra, level, envelope and ribs, speeds
/// weighted by how much of the recording is there. Speeds at which nothing was generated do not count.
[[nodiscard]] double textureDistance(std::span<const TextureFigures> recorded,
                                     std::span<const TextureFigures> generated, double bandwidthHz);

/// What the network makes of an embedding: its figures at each speed, and how its ribs lie to the phase that it is
/// told.
struct Resynthesis {
    std::vector<TextureFigures> figures;
    RibFundamentals fundamentals{};
};

/// Compares embeddings by what the network makes of them along the recording's own motion.
class TextureFit {
public:
    /// `unitWave`: the recording divided by its level. All of it must outlive the fit.
    TextureFit(ClosedLoop& loop, const PreparedRecording& recording, const Sliding& sliding,
               std::span<const float> unitWave, std::span<const float, 2 * inference::ribCount> waveVectors,
               std::uint64_t seed);

    [[nodiscard]] const SpeedBins& bins() const noexcept { return bins_; }
    [[nodiscard]] std::span<const TextureFigures> recorded() const noexcept { return recorded_; }
    [[nodiscard]] std::span<const float> unitWave() const noexcept { return unitWave_; }
    /// For each sample of the recording; empty without ribs.
    [[nodiscard]] std::span<const RibWay> ways() const noexcept { return ways_; }

    /// The distance of each embedding, all with the same noise, on `chains` stretches spread over the speeds; another
    /// `round` takes others.
    [[nodiscard]] std::vector<double> distances(std::span<const Embedding> embeddings, std::size_t chains,
                                                std::uint64_t round);

    /// What the network makes of an embedding along the whole recording, several times over, at 72 updates a second.
    [[nodiscard]] Resynthesis resynthesis(const Embedding& embedding);

private:
    [[nodiscard]] std::vector<std::vector<std::size_t>> startsByBin(std::size_t samples) const;
    void addFundamentals(RibFundamentals& sums, std::span<const float> wave, std::size_t chainStart,
                         std::size_t start) const;
    void measure(TextureMeter& meter, std::span<const float> wave, std::size_t start, std::size_t hop) const;

    ClosedLoop& loop_;
    const PreparedRecording& recording_;
    const Sliding& sliding_;
    std::span<const float> unitWave_;
    std::vector<RibWay> ways_;
    std::uint64_t seed_;
    SpeedBins bins_;
    std::vector<TextureFigures> recorded_;
    std::vector<std::vector<std::size_t>> starts_;
};

}  // namespace haptoflow::learning
