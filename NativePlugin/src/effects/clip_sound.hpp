#pragma once

#include "effects/effect.hpp"

#include <cstddef>
#include <span>

namespace haptoflow::effects {

/// Adds a finished wave to a voice: an author's clip beside the texture. One at a time; a new one replaces the present
/// one, whose last value decays within some milliseconds. Cubic interpolation to the output rate. Construction
/// excepted, everything runs on the audio thread.
class ClipSound final : public Effect {
public:
    /// Of the waves.
    static constexpr double waveRateHz = 8000.0;

    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit ClipSound(double sampleRateHz);

    /// Plays a wave in m/s^2 from the next sample on, again and again if it is a loop. It must live until the next
    /// `start`, `leave` or `reset`. Samples that are not finite count as 0, as does such a gain.
    void start(std::span<const float> waveMps2, float gain, bool isLoop) noexcept;
    /// Reads the wave no more: its last value decays.
    void leave() noexcept;

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return wave_.empty() && tail_ == 0.0F; }

private:
    [[nodiscard]] float next() noexcept;
    [[nodiscard]] float sampleAt(std::ptrdiff_t index) const noexcept;

    double step_;
    float decay_;
    std::span<const float> wave_;
    bool isLoop_ = false;
    float gain_ = 0.0F;
    double place_ = 0.0;
    float newest_ = 0.0F;
    float tail_ = 0.0F;
};

}  // namespace haptoflow::effects
