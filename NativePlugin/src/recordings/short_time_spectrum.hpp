#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// A number for each frame and bin of a ShortTimeSpectrum, frame by frame.
using SpectrumCells = std::vector<double>;

/// The spectrum of a wave at 2 kHz in frames of 64 ms that begin every 32 ms, under a square-root-Hann window before
/// the transform and after it: what is not scaled comes back as it was.
class ShortTimeSpectrum {
public:
    static constexpr std::size_t frameSamples = 128;
    static constexpr std::size_t hop = frameSamples / 2;
    static constexpr std::size_t bins = frameSamples / 2 + 1;

    /// The first frame begins `hop` samples before the wave; beyond its ends the wave is zero.
    explicit ShortTimeSpectrum(std::span<const float> wave);

    [[nodiscard]] std::size_t frames() const { return values_.size() / bins; }

    /// Squared magnitudes.
    [[nodiscard]] SpectrumCells power() const;

    void scale(const SpectrumCells& gains);

    [[nodiscard]] std::vector<float> wave() const;

    /// Mean square of a wave, in the wave's unit squared, with this mean power in each bin.
    [[nodiscard]] static double meanSquare(std::span<const double> power);

private:
    std::size_t samples_;
    std::vector<std::complex<double>> values_;
};

}  // namespace haptoflow::recordings
