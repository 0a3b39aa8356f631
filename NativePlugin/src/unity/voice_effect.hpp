#pragma once

#include "capi/voice_rendering.hpp"
#include "dsp/gain_ramp.hpp"

#include "unity/pass_through.hpp"
#include "unity/voice_claim.hpp"
#include "unity/voice_parameters.hpp"

#include <atomic>
#include <cstdint>

namespace haptoflow::unity {

/// What Unity says about a block besides its samples.
struct BlockContext {
    double sampleRateHz;
    /// Counts samples; the first of the block.
    std::uint64_t tick;
    /// Unity is playing, neither paused nor muted.
    bool isSounding;
};

/// One instance of the mixer effect: the voice in its channels, the input in the others. While nothing is to sound the
/// voice is not rendered: its clock stands still, and nothing is inferred for it.
class VoiceEffect {
public:
    /// Silence, from wherever the voice is.
    static constexpr double stopSeconds = 0.005;
    /// To another strength while the voice sounds, and back from silence.
    static constexpr double glideSeconds = 0.01;

    [[nodiscard]] VoiceParameters& parameters() noexcept { return parameters_; }

    /// The next block starts anew, at full strength and without a ramp. Any thread.
    void reset() noexcept { startAnew_.store(true, std::memory_order_relaxed); }

    /// Audio thread: no allocation, no lock, no system call, nothing unbounded.
    void process(const AudioBlock& block, const BlockContext& context) noexcept HAPTOFLOW_NONBLOCKING;

private:
    [[nodiscard]] bool missedBlocks(std::uint64_t tick, std::uint32_t frames) noexcept;
    /// Whether its newest block ended in sound: a gain that glides must not start one from the gain before a silence.
    [[nodiscard]] bool voiceSounds() const noexcept;
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
