#pragma once

#include "capi/voice_table.hpp"
#include "dsp/gate.hpp"
#include "unity/audio_effect_sdk.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::unity {

/// The voice that an effect plays, and its output channel.
struct Route {
    /// Place of the voice among the process's voices.
    std::size_t place = 0;
    /// HAPTOFLOW_ALL_CHANNELS or an index.
    std::int32_t channel = 0;

    [[nodiscard]] bool operator==(const Route&) const = default;
};

/// Parameters of the effect, which the mixer's inspector, snapshots and exposed parameters set. The main thread writes
/// and the audio thread reads, both without waiting.
class VoiceParameters {
public:
    /// Size of a value's text with the zero byte. Unity does not document the size of its buffer; FMOD, which it uses,
    /// guarantees this much.
    static constexpr std::size_t textSize = 16;
    static constexpr std::size_t parameterCount = 3;

    VoiceParameters() noexcept;

    /// Definitions in the order of the indices. They live as long as the library.
    [[nodiscard]] static std::span<AudioParameterDefinition> definitions() noexcept;

    /// Clamps `value` to the parameter's range and rounds places and channels. Returns false, without a change, for an
    /// invalid index or NaN.
    [[nodiscard]] bool set(int index, float value) noexcept;
    /// Either pointer may be null; `text` has room for textSize bytes. Returns false for an invalid index.
    [[nodiscard]] bool get(int index, float* value, char* text) const noexcept;

    [[nodiscard]] float strength() const noexcept;
    [[nodiscard]] Route route() const noexcept;

private:
    static_assert(std::atomic<float>::is_always_lock_free);

    std::array<std::atomic<float>, parameterCount> values_;
};

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
