#pragma once

#include "effects/effect.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace haptoflow::effects {

/// Everything comes a settable time later, for studies of latency and for slow displays.
///
/// The delay is a whole number of samples, the nearest to what is asked for: an impulse comes out exactly that much
/// later, and a delay of 0 passes the signal bit for bit.
///
/// A change while something sounds fades from the old tap of the line to the new one with a raised cosine of 20 ms:
///   out = w(t) new + (1 - w(t)) old,   w(t) = (1 - cos(pi t / 20 ms)) / 2.
/// The weights add up to 1 because nothing is known of how the two taps correlate, which changes with every frequency
/// and delay. So the output lies between the two taps at every sample, whatever their correlation: it is never louder
/// than the louder one. Weights of equal power would exceed it by 3 dB where the taps are alike, as they are after a
/// small change; these dip by 3 dB for an instant where the taps are unrelated. Changes that come during a fade wait
/// for its end; the newest wins. While the line holds only silence a change takes effect at once.
///
/// Audio thread but for construction and `declaration`. Allocates nothing, waits for nothing. Samples that are not
/// finite go in as 0 and are counted.
class Delay final : public Effect {
public:
    static constexpr double highestSeconds = 0.5;
    static constexpr double fadeSeconds = 0.02;

    /// Prepares for the longest delay. Throws std::invalid_argument unless `sampleRateHz` is 8000 to 192000.
    explicit Delay(double sampleRateHz);

    /// From the next sample on; clamped to 0-0.5 s, NaN is ignored. May be called before every block.
    void setDelaySeconds(double seconds) noexcept;
    /// What was asked for last, to the nearest sample; a fade to it may be waiting or under way.
    [[nodiscard]] double delaySeconds() const noexcept;

    /// Latency and tail are the delay; while it fades, the longer one of the two.
    [[nodiscard]] EffectDeclaration declaration() const noexcept override;
    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    /// True only while the line holds nothing but silence, up to the longest delay.
    [[nodiscard]] bool isIdle() const noexcept override;


private:
    void write(float sample) noexcept;
    [[nodiscard]] float tap(std::size_t delaySamples) const noexcept;
    void startFadeIfAsked() noexcept;
    [[nodiscard]] float nextOfFade() noexcept;
    void declare() noexcept;

    double sampleRateHz_;
    std::size_t longest_;
    std::vector<float> line_;
    std::vector<float> fade_;
    /// Where the newest sample lies.
    std::size_t newest_ = 0;
    /// Samples since the line held nothing but silence, and since it last got a sound; both stop at the longest delay.
    std::size_t held_ = 0;
    std::size_t silent_;
    std::size_t asked_ = 0;
    std::size_t current_ = 0;
    std::size_t previous_ = 0;
    /// Steps of the fade done; its length when none is under way.
    std::size_t faded_;

    std::atomic<double> declaredSeconds_{0.0};
};

}  // namespace haptoflow::effects
