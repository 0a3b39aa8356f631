#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::effects {

/// An amplitude of m/s^2 that counts as silence: a hundredth of a fingertip's lowest detection threshold.
inline constexpr double imperceptibleMps2 = 1e-4;

/// What a voice's signal can go through, in this order, but for the last two. `texture` is what the network generates,
/// and `tone` what a material or surface does to its spectrum, before anything else; the engine makes both. `signal` is
/// a study's sine, which stands for texture, impact and edge.
enum class EffectKind : std::uint8_t { texture, impact, edge, delay, compensation, exposureGuard, tone, signal };
inline constexpr std::size_t effectKinds = 8;

/// A set of effects, one bit for each kind.
using EffectMask = std::uint32_t;
[[nodiscard]] constexpr EffectMask maskOf(EffectKind kind) noexcept {
    return EffectMask{1} << static_cast<unsigned>(kind);
}

/// Fields of a contact state that an effect reads, one bit each.
namespace contact_field {
inline constexpr std::uint32_t none = 0;
inline constexpr std::uint32_t touch = 1;
inline constexpr std::uint32_t approachSpeed = 2;
inline constexpr std::uint32_t velocity = 4;
inline constexpr std::uint32_t force = 8;
inline constexpr std::uint32_t material = 16;
}  // namespace contact_field

/// What an effect costs beside time.
struct EffectDeclaration {
    EffectKind kind{};
    /// Bits of `contact_field`.
    std::uint32_t reads = contact_field::none;
    /// By how much the signal comes later; 0 for what only adds to it.
    double latencySeconds = 0.0;
    /// How long it may sound after its input has ended.
    double tailSeconds = 0.0;
    /// Allocated when it was made.
    std::size_t memoryBytes = 0;
};

/// A stage of a voice's chain, made for one output rate on a thread that can wait: the constructor prepares, designs
/// and allocates. What follows runs on the audio thread: it allocates nothing, waits for nothing and is bounded.
class Effect {
public:
    Effect() = default;
    Effect(const Effect&) = delete;
    Effect& operator=(const Effect&) = delete;
    virtual ~Effect() = default;

    /// Any thread.
    [[nodiscard]] virtual EffectDeclaration declaration() const noexcept = 0;
    /// Works on the next samples in place, m/s^2. A source adds to them.
    virtual void process(std::span<float> samplesMps2) noexcept = 0;
    /// Forgets all signal, as if just made; settings stay.
    virtual void reset() noexcept = 0;
    /// True while silence going in would come out as silence, now and later: the stage need not run then.
    [[nodiscard]] virtual bool isIdle() const noexcept = 0;
};

}  // namespace haptoflow::effects
