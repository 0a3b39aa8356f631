#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <optional>
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

inline constexpr double lightestTouchNewtons = 0.02;

/// How the tip moves during one frame of a ShortTimeSpectrum.
struct FrameMotion {
    /// False at the ends of the recording and where the motion is unknown; the other members then mean nothing.
    bool isUsable = false;
    /// The tip rests from 50 ms before the frame to 50 ms after it.
    bool isResting = false;
    bool isTouching = false;
    double speedMps = 0.0;
};

/// For each frame. `motion`, for each sample: vx, vy in m/s and force in N.
[[nodiscard]] std::vector<FrameMotion> motionOfFrames(std::size_t frames, std::span<const std::array<float, 3>> motion,
                                                      std::span<const std::uint8_t> isUsable);

/// Numbers of frames of a ShortTimeSpectrum, ascending.
using Frames = std::vector<std::size_t>;

/// The usable frames of which `condition` holds.
template <typename Condition>
[[nodiscard]] Frames framesWhere(std::span<const FrameMotion> motion, Condition condition) {
    Frames frames;
    for (std::size_t frame = 0; frame < motion.size(); ++frame) {
        if (motion[frame].isUsable && condition(motion[frame])) {
            frames.push_back(frame);
        }
    }
    return frames;
}

/// Mean square of each frame.
[[nodiscard]] std::vector<double> meanSquaresOf(const SpectrumCells& power, const Frames& frames);

[[nodiscard]] std::vector<double> meanSpectrum(const SpectrumCells& power, std::span<const std::size_t> frames);

/// Mean over two bins on each side: noise has a smooth spectrum, and few frames of it a rough one.
[[nodiscard]] std::vector<double> smoothed(std::span<const double> spectrum);

/// Of one value or more.
[[nodiscard]] double meanOf(std::span<const double> values);

/// The value below which `share` of one value or more lies.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The mean power of the sensor's noise in each bin, found where the tip is slower than 15 mm/s. A straight line is
/// fitted to the power over speed^1.2, and its value at speed zero is the noise. The power of every label grows at
/// least as fast as speed^1.2, so that the line never takes a part of the texture for noise.
///
/// None unless that is most of what is there, steady, below 0.1 m/s^2 and far below the level of fast strokes: a
/// texture must never be taken for noise.
[[nodiscard]] std::optional<std::vector<double>> noiseOfQuietPart(const SpectrumCells& power,
                                                                  std::span<const FrameMotion> motion);

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

/// Finds the noise where the tip rests for 0.2 s or more in all, knocks left out; otherwise in the quiet part
/// (quiet_part.hpp). A rest that is louder than the quietest sliding is not believed: then the motion is wrong. Throws
/// RecordingUnusable if the recording is no stronger where the tip slides than where it rests.
[[nodiscard]] SensorNoise findSensorNoise(const SpectrumCells& power, std::span<const FrameMotion> motion);

}  // namespace haptoflow::recordings
