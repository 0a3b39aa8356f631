#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
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

enum class NoiseSource : std::uint8_t {
    /// No part of the recording shows it, or it is too weak to matter.
    none,
    /// Where the tip rests on the surface or in the air.
    rest,
    /// Where the tip moves so slowly that the level no longer follows the speed.
    quietPart
};

/// "none", "rest" or "quiet part", for reports.
[[nodiscard]] std::string_view nameOf(NoiseSource source);

/// The noise of the accelerometer, which is in every part of a recording alike.
struct SensorNoise {
    NoiseSource source = NoiseSource::none;
    double rmsMps2 = 0.0;
    /// Mean power of each bin of a ShortTimeSpectrum; empty where there is none.
    std::vector<double> power;
};

/// vx, vy in m/s and force in N.
[[nodiscard]] std::array<double, 3> meanMotionOf(std::span<const std::array<float, 3>> motion);

/// Finds the sensor's noise and subtracts its power from the wave's, at every time and frequency, so that level and
/// spectrum are those of the surface. What is far above the noise is not changed, attacks included; where no noise is
/// found, no bit is. The power left is at least a hundredth of what was there.
///
/// wave: 2 kHz, m/s^2. motion: vx, vy in m/s and force in N for each sample. isUsable: 0 where the wave is unknown; it
/// is finite there, too. Throws RecordingUnusable if the recording is no stronger where the tip
/// slides than where it rests.
SensorNoise removeSensorNoise(std::span<float> wave, std::span<const std::array<float, 3>> motion,
                              std::span<const std::uint8_t> isUsable);

}  // namespace haptoflow::recordings
