#pragma once

#include "capi/voice_table.hpp"
#include "dsp/gate.hpp"
#include "unity/voice_parameters.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptoflow::unity {

/// Interleaved input and output frames of one callback. `in` and `out` may be the same memory, even if the numbers of
/// channels differ.
struct AudioBlock {
    /// Null for no input.
    const float* in;
    float* out;
    std::uint32_t frames;
    std::uint32_t inChannels;
    std::uint32_t outChannels;
};

/// Copies input channel n to output channel n. Output channels without an input channel become silent.
void passThrough(const AudioBlock& block) noexcept;

/// An effect's exclusive right to render the voice at a place. Rendering advances the voice's clock, so of two effects
/// on one voice, each would play only every other block. The first effect to ask gets the place. Another effect gets it
/// after it was given back or has not been used for 100 ms, for example because Unity no longer calls the first effect.
/// Wait-free.
class VoiceClaim {
public:
    static constexpr double abandonedSeconds = 0.1;

    VoiceClaim() noexcept;
    VoiceClaim(const VoiceClaim&) = delete;
    VoiceClaim& operator=(const VoiceClaim&) = delete;
    ~VoiceClaim() { giveBack(); }

    /// Call before rendering `frames` frames. Returns whether this effect may render the voice at `place`, which must
    /// be in range. Gives back any other place.
    [[nodiscard]] bool hold(std::size_t place, std::uint32_t frames, double sampleRateHz) noexcept;
    void giveBack() noexcept;

private:
    static constexpr std::size_t nowhere = capi::VoiceTable::capacity;

    std::uint32_t self_;
    std::size_t place_ = nowhere;
    // Value of the place at the last call, and the number of frames for which it has not changed.
    std::uint64_t found_ = 0;
    std::uint64_t unchangedFrames_ = 0;
};

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
