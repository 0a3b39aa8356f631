#pragma once

#include "dsp/sample_rates.hpp"
#include "effects/perceived_intensity.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::effects {

/// Low-pass filters a wave and keeps every `factor`-th sample. The filter is a Kaiser-windowed sinc: flat to a quarter
/// of the new rate, -6 dB at half of it, -50 dB from three quarters on. Used by one thread at a time; only the
/// constructor allocates.
class WaveDecimation {
public:
    static constexpr std::size_t maximumFactor = 96;
    /// Delay of the filter in samples of the new rate.
    static constexpr std::size_t delaySamples = 3;

    /// `factor` is 1 to maximumFactor; 1 passes every sample unchanged and without delay. Throws std::invalid_argument.
    explicit WaveDecimation(std::size_t factor);

    /// Takes a sample at the old rate; a non-finite one counts as 0. Returns true if it completes a sample at the new
    /// rate, and then writes that to `decimated`.
    [[nodiscard]] bool take(float sample, float& decimated) noexcept;
    void reset() noexcept;

private:
    std::size_t factor_;
    std::vector<float> kernel_;
    std::vector<float> newest_;
    std::size_t place_ = 0;
    std::size_t untilNext_;
};

/// A whole wave decimated by a factor, without the filter's delay: as many samples as fit. Throws
/// std::invalid_argument. Allocates.
[[nodiscard]] std::vector<float> decimated(std::span<const float> wave, std::size_t factor);

/// A sudden rise of the envelope: the onset of a tap or an edge.
struct WaveTransient {
    /// Time from the start of the frame to the onset, 0 to the frame's length.
    float offsetSeconds = 0.0F;
    /// Amplitude in m/s^2 of a sinusoid of `frequencyHz` that is as intense as the wave's peak at its own frequency; 0
    /// for no transient.
    float amplitudeMps2 = 0.0F;
    float frequencyHz = 0.0F;
};

/// The carrier that a motor plays for the length of one frame to feel like the wave.
struct WaveFrame {
    /// In samples of 2 kHz since construction or reset.
    std::uint64_t firstSample = 0;
    std::uint32_t sampleCount = 0;
    /// Perceived intensity of the wave, 1 at the detection threshold.
    float intensity = 0.0F;
    /// Mean frequency of what is felt of the wave; in silence, the last one.
    float centroidHz = 0.0F;
    /// The carrier: the centroid mapped to the device's range, and the peak amplitude in m/s^2 at which a sinusoid of
    /// that frequency has the wave's intensity.
    float frequencyHz = 0.0F;
    float amplitudeMps2 = 0.0F;
    /// For devices whose carrier cannot change abruptly; the carrier's amplitude already contains it.
    WaveTransient transient;
};

/// Frame length and the device's range.
struct WaveFeatureOptions {
    /// 2 to 32 ms: 4-8 ms for devices that take points in time (a sixth to a third of the period of the fastest
    /// envelope that is felt), else the interval at which the device takes values. Need not be a whole number of
    /// samples.
    double frameSeconds = 0.005;
    /// The device's range; equal for a motor with one frequency.
    double minFrequencyHz = 60.0;
    double maxFrequencyHz = 400.0;

    /// False for values out of range or not finite.
    [[nodiscard]] bool isValid() const noexcept;
};

/// Converts a 2 kHz wave in m/s^2, from a voice or a recording, to a sequence of frames for devices that play a
/// carrier. As in Intensity Segment Modulation, each frame has the perceived intensity of the wave.
///
/// The wave is weighted by 1 / T(f), so that it is in multiples of the detection threshold. A frame's r^2 is twice the
/// mean square of the weighted wave over the frame, which is lengthened to whole half periods so that a slow sinusoid
/// does not pulse. The spectrum covers the last 64 ms in a window that rises for 56 ms and falls for 8 ms, because a
/// single frame would resolve only 125-250 Hz. perceived_intensity.hpp gives the intensity, whose exponent a is the
/// mean over the weighted spectrum, and the carrier of equal intensity.
///
/// The centroid is the mean of the logarithm of frequency over the bins that exceed the threshold, by their energy in
/// (m/s^2)^2. Weighted by sensitivity instead, every texture would lie near 110 Hz, where a hand is most sensitive. A
/// device that covers 50 to 240 Hz, where the centroids of textures lie, plays it as it is, limited to its range. Into
/// a narrower range that interval is compressed on a logarithmic scale, so that textures keep their order.
///
/// In 5 ms of noise an energy is off by many decibels, which no hand follows. Therefore r^2 follows the frames with a
/// time constant of 15 ms, and the centroid with 40 ms. Three kinds of frames are not smoothed, because they are
/// sudden: one whose r^2 is more than four times the smoothed one; those of the 30 ms after an onset, and after these
/// as long as r^2 falls; and the second of two frames in a row below an eighth of the smoothed r^2, and after it as
/// long as r^2 falls. So an impact arrives in its own frame at full height.
///
/// Onsets are detected sample by sample: the mean square of the last 4 ms, if it is felt, is compared with an
/// exponential mean of 30 ms that ended 5 ms earlier. They are at least 30 ms apart. The onset is the sample at which
/// the wave first reached a quarter of its peak within the preceding 8 ms. Its amplitude is the peak of the following
/// samples, up to 8 ms, and its frequency is that of the sinusoid with the same ratio of differences to sums of
/// neighbouring samples. A frame contains at most one onset, the first; a frame before an onset excludes everything
/// after it.
///
/// `process` accepts any number of samples. Used by one thread at a time; only the constructor allocates, and the work
/// per sample and per frame is bounded. Non-finite samples count as 0.
class WaveFeatures {
public:
    static constexpr double sampleRateHz = dsp::waveformRateHz;
    /// Number of samples after its end at which a frame is ready; the threshold filter and the transients need them.
    static constexpr std::size_t lookaheadSamples = 8;
    static constexpr double latencySeconds = static_cast<double>(lookaheadSamples) / sampleRateHz;

    struct Progress {
        std::size_t samples = 0;
        std::size_t frames = 0;
    };

    /// Throws std::invalid_argument for invalid options.
    explicit WaveFeatures(const WaveFeatureOptions& options = {});

    /// Takes samples and writes the frames that they complete; stops before a frame that does not fit into `frames`.
    [[nodiscard]] Progress process(std::span<const float> waveMps2, std::span<WaveFrame> frames) noexcept;
    /// Upper bound of the number of frames in so many samples.
    [[nodiscard]] std::size_t framesWithin(std::size_t samples) const noexcept;
    /// Changes the device's range from the next frame on. Ignored unless both are finite and 0 < min <= max <= 1000.
    void setDeviceRange(double minFrequencyHz, double maxFrequencyHz) noexcept;
    /// Clears the history; the next sample is sample 0.
    void reset() noexcept;

private:
    static constexpr std::size_t historySamples = ThresholdFilter::taps;
    static constexpr std::size_t bins = historySamples / 2;
    using History = std::array<double, historySamples>;

    struct Spectrum {
        /// In multiples of the threshold, squared.
        double energy = 0.0;
        double weightedCentroidHz = 0.0;
        double exponent = 0.0;
        /// Of what exceeds the threshold; 0 if nothing does.
        double feltHz = 0.0;
    };

    void take(double mps2) noexcept;
    [[nodiscard]] double filtered() const noexcept;
    void followEnergy() noexcept;
    void detectOnset() noexcept;
    [[nodiscard]] std::uint64_t onsetBefore(std::uint64_t end) const noexcept;
    [[nodiscard]] std::uint64_t frameStart(std::uint64_t frame) const noexcept;
    [[nodiscard]] bool isFrameDue() const noexcept;
    [[nodiscard]] WaveFrame finishFrame() noexcept;
    [[nodiscard]] Spectrum spectrumOfHistory() const noexcept;
    [[nodiscard]] double meanSquare(std::uint64_t start, std::uint64_t end, double centroidHz) const noexcept;
    [[nodiscard]] WaveTransient transientWithin(std::uint64_t start, std::uint64_t end) noexcept;
    void follow(double square, const Spectrum& spectrum, bool hasOnset) noexcept;
    [[nodiscard]] double onDevice(double frequencyHz) const noexcept;

    WaveFeatureOptions options_;
    const ThresholdFilter& filter_;
    History window_{};
    History cosines_{};
    std::array<double, bins> exponents_{};
    std::array<double, bins> logFrequencies_{};
    /// T^2 of each bin, and the energy of a sinusoid at the threshold in its bin.
    std::array<double, bins> squaredThresholds_{};
    double thresholdEnergy_ = 0.0;
    double frameSamples_;
    double slowShare_;

    /// Ring buffers of the newest samples, unweighted and in multiples of the threshold.
    History wave_{};
    History thresholds_{};
    std::uint64_t taken_ = 0;
    std::uint64_t frame_ = 0;
    double weightedCentroidHz_ = 0.0;
    double centroidHz_ = 0.0;
    /// r^2 as it is followed, and of the last frame alone.
    double square_ = 0.0;
    double lastSquare_ = 0.0;
    std::uint64_t suddenUntil_ = 0;
    double slowEnergy_ = 0.0;
    double fastEnergy_ = 0.0;
    bool hasOnset_ = false;
    std::uint64_t onset_ = 0;
    std::uint64_t refractoryUntil_ = 0;
};

}  // namespace haptoflow::effects
