#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

/// An amplitude of m/s^2 that counts as silence: a hundredth of a fingertip's lowest detection threshold.
inline constexpr double imperceptibleMps2 = 1e-4;

/// The effects of a voice in the order of processing, except for the last five. `texture` is the generated waveform,
/// and `tone` filters it before any other effect; the engine implements both. `signal` is a sinusoid for studies, which
/// replaces texture, impact, edge and relief. `listen` is for ears and acts after the compensation. `relief` is added
/// where impact and edge are, and so is `clip`, which sounds with or without contact.
enum class EffectKind : std::uint8_t {
    texture,
    impact,
    edge,
    delay,
    compensation,
    exposureGuard,
    tone,
    signal,
    listen,
    relief,
    clip
};
inline constexpr std::size_t effectKinds = 11;

/// A set of effects, one bit per kind.
using EffectMask = std::uint32_t;
[[nodiscard]] constexpr EffectMask maskOf(EffectKind kind) noexcept {
    return EffectMask{1} << static_cast<unsigned>(kind);
}

/// A stage of a voice's chain for one output rate. The constructor designs and allocates, so it runs on a thread that
/// may wait. All other functions run on the audio thread: they allocate nothing, wait for nothing and take bounded
/// time.
class Effect {
public:
    Effect() = default;
    Effect(const Effect&) = delete;
    Effect& operator=(const Effect&) = delete;
    virtual ~Effect() = default;

    /// Processes the next samples in place, m/s^2. A source adds to them.
    virtual void process(std::span<float> samplesMps2) noexcept = 0;
    /// Clears all signal state; settings stay.
    virtual void reset() noexcept = 0;
    /// True while silent input gives silent output, now and later, so that the stage need not run.
    [[nodiscard]] virtual bool isIdle() const noexcept = 0;
};

}  // namespace haptoflow::effects
