#pragma once

#include "effects/effect.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

/// One vibration mode, amplitude e^(-decay t) sin(2 pi frequency t), computed by a recursion with two multiplications
/// per sample. Audio thread: allocates nothing, waits for nothing.
class DecayingSinusoid {
public:
    /// Replaces the present sinusoid from the next sample on. A frequency above 0.45 of the rate, or an argument that
    /// is not finite and above 0, gives silence.
    void start(double frequencyHz, double decayPerSecond, double amplitudeMps2, double sampleRateHz) noexcept;
    void stop() noexcept { *this = DecayingSinusoid(); }
    /// Adds the next samples of the sinusoid to `samplesMps2`.
    void addTo(std::span<float> samplesMps2) noexcept;

    [[nodiscard]] bool isIdle() const noexcept { return envelopeMps2_ < imperceptibleMps2; }
    /// The present amplitude of the decaying envelope.
    [[nodiscard]] double envelopeMps2() const noexcept { return envelopeMps2_; }

private:
    double newest_ = 0.0;
    double previous_ = 0.0;
    double feedback_ = 0.0;
    double damping_ = 0.0;
    double decay_ = 0.0;
    double envelopeMps2_ = 0.0;
};

/// Response of a material to a contact event: a sum of decaying sinusoids with amplitudes proportional to the speed of
/// the contact event (Okamura, Cutkosky, Dennerlein 2001: a(t) = A(v) e^(-Bt) sin(2 pi f t)).
struct ImpactResponse {
    struct Mode {
        /// 0 for an unused mode.
        float frequencyHz = 0.0F;
        float decayPerSecond = 0.0F;
        /// m/s^2 per m/s of the contact event.
        float gainPerSecond = 0.0F;
    };
    static constexpr std::size_t modeCount = 2;
    std::array<Mode, modeCount> modes{};
    static constexpr double maximumRestitution = 0.9;
    /// Share of the speed that a rebound keeps, 0 to 0.9; 0 for no rebounds.
    float restitution = 0.0F;
};

/// Renders contact events: the landing of a tip (kind impact) or the crossing of an edge (kind edge).
///
/// Overlapping contact events add up. If all sinusoids are in use, a new one replaces the quietest. Construction
/// excepted, everything runs on the audio thread.
class Impacts final : public Effect {
public:
    /// Speeds are clamped to this.
    static constexpr double maximumEventMps = 5.0;
    static constexpr std::size_t capacity = 8;
    static constexpr std::size_t rebounds = 2;

    /// `decayFactor` multiplies the decay of the responses, which makes edges shorter than landings.
    explicit Impacts(double sampleRateHz, double decayFactor = 1.0) noexcept;

    /// Starts a contact event with the next sample; its rebounds follow. Ignores a speed that is not above 0.
    void start(double speedMps, const ImpactResponse& response) noexcept;

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return isIdle_; }

private:
    struct Rebound {
        std::uint64_t samplesLeft = 0;
        double speedMps = 0.0;
        ImpactResponse response{};
    };

    void ring(double speedMps, const ImpactResponse& response) noexcept;
    void planRebound(double speedMps, const ImpactResponse& response) noexcept;

    double sampleRateHz_;
    double decayFactor_;
    std::array<DecayingSinusoid, capacity> ringing_{};
    Rebound rebound_{};
    std::size_t reboundsLeft_ = 0;
    // Cached, because every voice reads it several times per block.
    bool isIdle_ = true;
};

}  // namespace haptoflow::effects
