#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::effects {

/// Multiplies a wave by a gain that follows its envelope: a compressor that does not bend the waveform.
///
/// The wave is cut into steps of half a millisecond. The envelope is the largest magnitude of the last 9 ms (half a
/// period of 56 Hz, so that a slow sinusoid does not modulate its own gain), and falls by 1/e in 20 ms afterwards. The
/// gain changes linearly within each step and is never above the gain of the envelope that a step has; the wave is
/// delayed by two steps for that. With a law whose gain falls as the envelope rises, the output thereby never exceeds
/// what the law gives for the envelope, not even at an onset.
///
/// Non-finite samples count as 0, magnitudes are limited to 1e6. Used by one thread at a time. Allocates nothing.
class EnvelopeGain {
public:
    /// Delay of the wave. At rates that are not a multiple of 2 kHz, the next whole number of samples.
    static constexpr double latencySeconds = 0.001;

    /// Gain for an envelope of 0 or more; finite, 0 or more, and not rising with the envelope.
    using Law = float (*)(float envelope);

    /// Throws std::invalid_argument for a rate outside 2-192 kHz.
    EnvelopeGain(double sampleRateHz, Law law);

    void process(std::span<float> samples) noexcept;
    /// Silence from here on, with the gain of silence.
    void reset() noexcept;
    /// Silence from here on after an envelope of this size, from which the gain rises within the time of the release.
    void begin(float envelope) noexcept;
    /// True while silent input gives silent output.
    [[nodiscard]] bool isIdle() const noexcept { return silentSteps_ > delaySteps; }

private:
    static constexpr std::size_t delaySteps = 2;
    static constexpr std::size_t longestStep = 96;
    static constexpr std::size_t holdSteps = 18;

    void finishStep() noexcept;

    Law law_;
    std::size_t stepSamples_;
    std::array<float, delaySteps * longestStep> delayed_{};
    std::size_t place_ = 0;
    std::array<float, holdSteps> peaks_{};
    std::size_t peakPlace_ = 0;
    std::size_t inStep_ = 0;
    float peak_ = 0.0F;
    float envelope_ = 0.0F;
    /// Gain of the newest complete step, and the gains at the two ends of the step that is played.
    float newestGain_ = 0.0F;
    float gainFrom_ = 0.0F;
    float gainTo_ = 0.0F;
    std::size_t silentSteps_ = 0;
};

}  // namespace haptoflow::effects
