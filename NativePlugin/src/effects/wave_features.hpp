#pragma once

#include "dsp/sample_rates.hpp"
#include "effects/threshold_filter.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

/// A jump of the envelope: the onset of a tap or an edge.
struct WaveTransient {
    /// From the start of its frame to the onset, 0 to the frame's length.
    float offsetSeconds = 0.0F;
    /// Of a sinusoid of `frequencyHz` that is as intense as the wave's peak at its own frequency, m/s^2. 0 for none.
    float amplitudeMps2 = 0.0F;
    float frequencyHz = 0.0F;
};

/// What a motor has to do for the length of one frame to feel like the wave.
struct WaveFrame {
    /// In samples of 2 kHz since the features were made or reset.
    std::uint64_t firstSample = 0;
    std::uint32_t sampleCount = 0;
    /// Perceived intensity of the wave, 1 at the detection threshold.
    float intensity = 0.0F;
    /// Spectral centroid of the wave as the hand weighs it; the last one that was felt while it is silent.
    float centroidHz = 0.0F;
    /// The carrier: the centroid, clamped to what the device can play, and the amplitude (peak, m/s^2) at which a
    /// sinusoid of that frequency is as intense.
    float frequencyHz = 0.0F;
    float amplitudeMps2 = 0.0F;
    /// Amplitude 0 for none. The carrier's amplitude holds it already: it is for devices whose carrier cannot jump.
    WaveTransient transient;
};

/// How a wave is cut and what the device can play.
struct WaveFeatureOptions {
    /// 4-8 ms for devices that take points in time (a sixth to a third of the period of the fastest envelope that is
    /// felt), or the interval at which a device takes values; 2 to 32 ms. Need not be a whole number of samples.
    double frameSeconds = 0.005;
    /// The device's range; both the same for a motor of one frequency.
    double minFrequencyHz = 60.0;
    double maxFrequencyHz = 400.0;
    /// An onset is where the energy of 4 ms is this many times what it was on average before (10.8 dB).
    double onsetEnergyRatio = 12.0;
    /// Times the detection threshold that an onset must reach.
    double onsetThresholds = 3.0;
    /// After an onset there is none for so long.
    double refractorySeconds = 0.03;

    /// False for values out of range or not finite.
    [[nodiscard]] bool isValid() const noexcept;
};

/// From a wave of 2 kHz in m/s^2, a voice's or a recording, to one frame after the other for devices that play a
/// carrier: after Intensity Segment Modulation, each frame is to feel as intense as the wave did.
///
/// The wave is weighted by 1 / T(f), so that it is in multiples of what is just felt. A frame's r^2 is twice the mean
/// square of that, over the frame, lengthened to whole half periods of the centroid so that a slow sinusoid does not
/// pulse. Its spectrum is that of the last 64 ms in a window that rises for 56 ms and falls for 8 ms (a frame alone
/// would resolve no more than 125-250 Hz), divided by T(f) like the wave; the centroid and the exponent a are means
/// over it. Intensity, and the carrier as intense: perceived_intensity.hpp.
///
/// Onsets are looked for sample by sample: the mean square of the last 4 ms is compared with an exponential mean of
/// 30 ms that ended 5 ms earlier; the onset is where the wave itself first reached a quarter of its peak in the 8 ms
/// before that. Its amplitude is the wave's peak in the samples that follow, 8 ms or as many as are there, and its
/// frequency that of the sinusoid with the same ratio of differences and sums of neighbours. A frame holds one onset at
/// most, the first; nothing that follows an onset counts for a frame before it.
///
/// Streaming: `process` takes however many samples there are. Any one thread; no allocation but in the constructor,
/// and the work for a sample and for a frame is bounded. Samples that are not finite are taken as 0.
class WaveFeatures {
public:
    static constexpr double sampleRateHz = dsp::waveformRateHz;
    /// A frame is ready this many samples after its end: the threshold's filter and the transients need them.
    static constexpr std::size_t lookaheadSamples = 8;
    static constexpr double latencySeconds = static_cast<double>(lookaheadSamples) / sampleRateHz;

    struct Progress {
        std::size_t samples = 0;
        std::size_t frames = 0;
    };

    /// Throws std::invalid_argument for options that are not valid.
    explicit WaveFeatures(const WaveFeatureOptions& options = {});

    /// Takes samples and writes the frames that they complete; stops before a frame for which there is no room.
    [[nodiscard]] Progress process(std::span<const float> waveMps2, std::span<WaveFrame> frames) noexcept;
    /// Room that is always enough for the frames of so many samples.
    [[nodiscard]] std::size_t framesWithin(std::size_t samples) const noexcept;
    /// A device was replaced by another, or its capabilities have changed: from the next frame on. Ignored unless both
    /// are finite and 0 < min <= max <= 1000.
    void setDeviceRange(double minFrequencyHz, double maxFrequencyHz) noexcept;
    /// Forgets the wave; the next sample is the first.
    void reset() noexcept;

private:
    static constexpr std::size_t historySamples = ThresholdFilter::taps;
    static constexpr std::size_t bins = historySamples / 2;
    using History = std::array<double, historySamples>;

    struct Spectrum {
        double energy = 0.0;
        double centroidHz = 0.0;
        double exponent = 0.0;
    };

    void take(double mps2) noexcept;
    [[nodiscard]] double filtered() const noexcept;
    void followEnergy() noexcept;
    void lookForOnset() noexcept;
    [[nodiscard]] std::uint64_t onsetBefore(std::uint64_t end) const noexcept;
    [[nodiscard]] std::uint64_t frameStart(std::uint64_t frame) const noexcept;
    [[nodiscard]] bool isFrameDue() const noexcept;
    [[nodiscard]] WaveFrame finishFrame() noexcept;
    [[nodiscard]] Spectrum spectrumOfHistory() const noexcept;
    [[nodiscard]] double meanSquare(std::uint64_t start, std::uint64_t end, double centroidHz) const noexcept;
    [[nodiscard]] WaveTransient transientWithin(std::uint64_t start, std::uint64_t end) noexcept;
    [[nodiscard]] double clampedToDevice(double frequencyHz) const noexcept;

    WaveFeatureOptions options_;
    const ThresholdFilter& filter_;
    History window_{};
    History cosines_{};
    std::array<double, bins> exponents_{};
    double frameSamples_;
    double slowShare_;
    std::uint64_t refractorySamples_;

    /// The newest samples, as they came and in multiples of the threshold, at their number modulo the length.
    History wave_{};
    History thresholds_{};
    std::uint64_t taken_ = 0;
    std::uint64_t frame_ = 0;
    double centroidHz_ = 0.0;
    double slowEnergy_ = 0.0;
    double fastEnergy_ = 0.0;
    bool hasOnset_ = false;
    std::uint64_t onset_ = 0;
    std::uint64_t quietUntil_ = 0;
};

}  // namespace haptoflow::effects
