#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace haptoflow::engine {

/// How long a contact state is good for: a tenth of a second, or longer where states come so seldom by design (10
/// frames a second, physics steps of 0.2 s). The period is the shorter of the last two, so that one long frame changes
/// nothing. A small value of the callback; allocates nothing.
class Staleness {
public:
    static constexpr double minimumSeconds = 0.1;
    static constexpr double maximumSeconds = 0.6;

    /// A state came, with others since the last block or alone, so long after the one before.
    void noteState(double secondsSinceLast) noexcept { gaps_ = {secondsSinceLast, gaps_[0]}; }

    /// Time without a contact state after which the contact is stale.
    [[nodiscard]] double seconds() const noexcept {
        return std::clamp(periods * std::min(gaps_[0], gaps_[1]), minimumSeconds, maximumSeconds);
    }

private:
    // One state may be missing, and the next late by half a period.
    static constexpr double periods = 2.5;

    std::array<double, 2> gaps_{};
};

/// Why a voice is silent. The values equal those of haptoflow_silence.
enum class Silence : std::int32_t {
    /// The voice is not silent.
    none = 0,
    /// The tip does not touch or does not slide.
    rest = 1,
    /// No contact state was published for 100 ms.
    stale = 2,
    muted = 3,
    paused = 4,
    /// A panic silenced this touch.
    panic = 5,
    /// The device's rate is not supported, or the voice is not prepared for it yet.
    rate = 6,
    /// The voice or its engine is being closed.
    closing = 7,
    /// The worker thread has ended.
    workerDead = 8,
    /// Strength or ceiling is 0.
    turnedDown = 9,
};

/// Conditions under which a voice may sound.
struct SoundConditions {
    /// The newest contact slides, or a tap is still being played.
    bool isTouched = false;
    bool isStale = false;
    bool isMuted = false;
    bool isPaused = false;
    /// The gain of the output is 0. It is only reported: the voice goes on, because a gain may return at any time.
    bool isTurnedDown = false;
    /// A panic occurred during this touch.
    bool isPanicked = false;
    bool isRateServed = true;
    bool isClosing = false;
    bool isWorkerAlive = true;
};

/// If several reasons hold, returns the most persistent one, because removing a shorter one first would have no effect.
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
    if (conditions.isTurnedDown) {
        return Silence::turnedDown;
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
