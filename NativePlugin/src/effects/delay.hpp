#pragma once

#include "effects/effect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::effects {

/// Delays the signal by a settable time, for studies of latency and for slow displays.
///
/// The delay is rounded to a whole number of samples. A delay of 0 passes the signal unchanged, bit for bit.
///
/// A change of the delay crossfades from the old tap of the line to the new one along a raised cosine of 20 ms:
///   out = w(t) new + (1 - w(t)) old, w(t) = (1 - cos(pi t / 20 ms)) / 2. The correlation of the two taps is unknown,
///   because it depends on the frequencies and on the delay. Weights that add up to 1 keep the output between the two
///   taps at every sample, so it is never louder than the louder tap. Equal-power weights would exceed it by 3 dB where
///   the taps are alike, as after a small change; these weights dip by 3 dB where the taps are uncorrelated. A change
///   during a crossfade waits for its end; of several, the newest counts. While the line holds only silence, a change
///   takes effect at once.
///
/// Non-finite samples enter the line as 0. Construction excepted, everything runs on the audio thread: allocates
/// nothing, waits for nothing.
class Delay final : public Effect {
public:
    static constexpr double maximumSeconds = 0.5;
    static constexpr double fadeSeconds = 0.02;

    /// Allocates the line for the maximum delay. Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit Delay(double sampleRateHz);

    /// Sets the delay from the next sample on, clamped to 0-0.5 s. Ignores NaN. May be called before every block.
    void setDelaySeconds(double seconds) noexcept;
    /// The delay set last, rounded to a sample. The crossfade to it may still be waiting or in progress.
    [[nodiscard]] double delaySeconds() const noexcept;

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    /// True only while the whole line, up to the maximum delay, holds silence.
    [[nodiscard]] bool isIdle() const noexcept override;

private:
    void write(float sample) noexcept;
    [[nodiscard]] float tap(std::size_t delaySamples) const noexcept;
    void startFadeIfRequested() noexcept;
    [[nodiscard]] float nextFadeSample() noexcept;

    double sampleRateHz_;
    std::size_t maximumSamples_;
    std::vector<float> line_;
    std::vector<float> fade_;
    /// Index of the newest sample.
    std::size_t newest_ = 0;
    /// Samples written since the last reset, and silent samples written since the last sound; both stop counting at the
    /// length of the maximum delay.
    std::size_t held_ = 0;
    std::size_t silent_;
    std::size_t requested_ = 0;
    std::size_t current_ = 0;
    std::size_t previous_ = 0;
    /// Completed steps of the crossfade; its length if none is in progress.
    std::size_t faded_;
};

}  // namespace haptoflow::effects
