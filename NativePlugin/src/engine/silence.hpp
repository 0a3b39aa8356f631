#pragma once

#include <cstdint>

namespace haptoflow::engine {

/// Why a voice is silent. The numbers are those of haptoflow_silence.
enum class Silence : std::int32_t {
    /// The voice sounds.
    none = 0,
    /// Nothing touches, or the tip does not slide.
    rest = 1,
    /// No contact state came for 100 ms.
    stale = 2,
    muted = 3,
    paused = 4,
    /// A panic silenced this touch.
    panic = 5,
    /// The device runs at a rate that the voice is not prepared for yet, or never will be.
    rate = 6,
    /// The voice, or its engine, is being closed.
    closing = 7,
    /// The thread that generates has ended.
    workerDead = 8,
};

/// What decides whether a voice may sound.
struct SoundConditions {
    /// The newest contact slides, or a tap has not been played to its end.
    bool isTouched = false;
    bool isStale = false;
    bool isMuted = false;
    bool isPaused = false;
    /// A panic was called during this touch.
    bool isPanicked = false;
    bool isRateServed = true;
    bool isClosing = false;
    bool isWorkerAlive = true;
};

/// The reason that lasts longest where several hold, so that a person who removes it makes progress.
[[nodiscard]] constexpr Silence silenceFor(const SoundConditions& conditions) noexcept {
    if (conditions.isClosing) {
        return Silence::closing;
    }
    if (!conditions.isWorkerAlive) {
        return Silence::workerDead;
    }
    if (conditions.isPaused) {
        return Silence::paused;
    }
    if (conditions.isMuted) {
        return Silence::muted;
    }
    if (!conditions.isRateServed) {
        return Silence::rate;
    }
    if (conditions.isStale) {
        return Silence::stale;
    }
    if (!conditions.isTouched) {
        return Silence::rest;
    }
    return conditions.isPanicked ? Silence::panic : Silence::none;
}

}  // namespace haptoflow::engine
