#pragma once

#include "capi/voice_rendering.hpp"
#include "dsp/gain_ramp.hpp"
#include "unity/pass_through.hpp"
#include "unity/voice_claim.hpp"
#include "unity/voice_parameters.hpp"

#include <atomic>
#include <cstdint>

namespace haptoflow::unity {

/// Properties of a block besides its samples, from Unity's state.
struct BlockContext {
    double sampleRateHz;
    /// Sample count at the start of the block.
    std::uint64_t tick;
    /// True if Unity is playing and neither paused nor muted.
    bool isSounding;
};

/// One instance of the mixer effect. It writes the voice to its channels and passes the input through on the others.
/// While the effect is paused, muted or stopped, the voice is not rendered, so that its clock stands still and no
/// inference runs for it.
class VoiceEffect {
public:
    /// Duration of the fade to silence.
    static constexpr double stopSeconds = 0.005;
    /// Duration of a change of strength while the voice sounds, and of the fade from silence.
    static constexpr double glideSeconds = 0.01;

    [[nodiscard]] VoiceParameters& parameters() noexcept { return parameters_; }

    /// Makes the next block start at full strength without a ramp. Any thread.
    void reset() noexcept { startAnew_.store(true, std::memory_order_relaxed); }

    /// Audio thread: no allocation, no lock, no system call; bounded time.
    void process(const AudioBlock& block, const BlockContext& context) noexcept HAPTOFLOW_NONBLOCKING;

private:
    /// Stores the position of the block and returns whether blocks are missing before it.
    [[nodiscard]] bool updateTick(std::uint64_t tick, std::uint32_t frames) noexcept;
    /// Whether the voice's newest block ended with sound. Only then may a new strength glide: from silence, a glide
    /// would start at the old strength.
    [[nodiscard]] bool isVoiceSounding() const noexcept;
    [[nodiscard]] capi::ChannelTarget target(const AudioBlock& block, std::uint32_t first,
                                             std::uint32_t count) const noexcept;
    void play(const capi::ChannelTarget& target, double sampleRateHz) noexcept;
    void applyGain(const capi::ChannelTarget& target) noexcept;

    VoiceParameters parameters_;
    std::atomic<bool> startAnew_{true};
    VoiceClaim claim_;
    dsp::GainRamp gain_;
    Route route_;
    std::uint64_t nextTick_ = 0;
    bool ticksFollow_ = false;
};

}  // namespace haptoflow::unity
