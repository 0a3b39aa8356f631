#pragma once

#include "engine/live_engine.hpp"
#include "haptoflow/haptoflow.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

namespace haptoflow::capi {

/// A voice with its engine, which it keeps alive until the voice is destroyed.
struct OpenVoice {
    std::shared_ptr<engine::LiveEngine> engine;
    std::shared_ptr<engine::LiveVoice> voice;
    std::atomic_flag publishing{};
    std::atomic_flag rendering{};
    std::atomic<std::uint64_t> refusedCalls{0};
    /// Only the thread that holds `rendering` uses it. As long as the blocks of any platform; longer blocks are split.
    std::array<float, 8192> block{};
};

/// The voices of the process in a fixed number of slots. A handle combines a slot and the number of its uses, so that a
/// lookup needs no lock and a closed voice is detected. Nothing waits for a fade: a closed voice is used only by its
/// renderer, which fades it and ends it with the fade. A later call of `open`, `close` or `closeAll` frees its memory.
class VoiceTable {
    struct Place {
        // The handle, or 0 while the slot is free or its voice has ended.
        std::atomic<haptoflow_voice> handle{0};
        std::atomic<std::uint32_t> users{0};
        std::unique_ptr<OpenVoice> voice;
        std::uint64_t generation = 0;
        std::chrono::steady_clock::time_point closedAt{};
    };

public:
    static constexpr std::size_t capacity = HAPTOFLOW_MAXIMUM_VOICES;
    /// Time after which a closed voice has ended although it still sounds, because nobody renders it. Longer than the
    /// longest common block, 4096 frames at 44.1 kHz, and a fade of 5 ms.
    static constexpr std::chrono::milliseconds fadeLimit{250};

    /// A user's reference to a voice; null if the handle is not open. Wait-free.
    class Use {
    public:
        Use() = default;
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;
        Use(Use&& other) noexcept : place_(std::exchange(other.place_, nullptr)) {}
        Use& operator=(Use&&) = delete;
        ~Use() {
            if (place_ != nullptr) {
                place_->users.fetch_sub(1, std::memory_order_release);
            }
        }
        [[nodiscard]] OpenVoice* get() const noexcept { return place_ != nullptr ? place_->voice.get() : nullptr; }
        [[nodiscard]] OpenVoice* operator->() const noexcept { return get(); }
        [[nodiscard]] explicit operator bool() const noexcept { return place_ != nullptr; }
        [[nodiscard]] bool isClosed() const noexcept;
        /// Ends a closed voice that is silent. For its renderer.
        void endOnceSilent() const noexcept;

    private:
        friend class VoiceTable;
        explicit Use(Place* place) noexcept : place_(place) {}

        Place* place_ = nullptr;
    };

    /// Throws std::invalid_argument if all slots are in use; a voice that still fades gives up its slot.
    [[nodiscard]] haptoflow_voice open(std::unique_ptr<OpenVoice> voice);
    /// Begins the fade of a voice and takes it from its engine. Waits for nothing. Returns false if the handle is not
    /// open.
    bool close(haptoflow_voice handle);
    /// Closes all voices of an engine.
    void closeAll(const engine::LiveEngine& engine);

    /// The voice of an open handle.
    [[nodiscard]] Use use(haptoflow_voice handle) noexcept;
    /// The voice of a handle that is open, or closed and still fading.
    [[nodiscard]] Use useToRender(haptoflow_voice handle) noexcept;
    /// The same for the voice in a slot, if there is one.
    [[nodiscard]] Use useAt(std::size_t place) noexcept;
    /// The slot of an open handle; capacity otherwise.
    [[nodiscard]] std::size_t placeOf(haptoflow_voice handle) noexcept;

private:
    /// Moved out under the mutex, to be destroyed outside of it.
    using Ended = std::vector<std::unique_ptr<OpenVoice>>;

    [[nodiscard]] Place* freePlace() noexcept;
    static void beginToClose(Place& place) noexcept;
    void collect(Ended& ended, bool endsFades = false);

    std::mutex mutex_;
    std::array<Place, capacity> places_;
};

[[nodiscard]] VoiceTable& voices() noexcept;

/// Throws std::invalid_argument for a voice that is not open.
[[nodiscard]] inline VoiceTable::Use requireVoice(haptoflow_voice voice) {
    VoiceTable::Use use = voices().use(voice);
    if (!use) {
        throw std::invalid_argument("not an open voice");
    }
    return use;
}

/// The destination of a voice's samples: one channel of interleaved frames, or all.
struct ChannelTarget {
    static constexpr std::uint32_t maximumChannels = 64;

    float* interleaved = nullptr;
    std::uint32_t frameCount = 0;
    std::uint32_t channelCount = 0;
    /// HAPTOFLOW_ALL_CHANNELS or an index.
    std::int32_t channel = HAPTOFLOW_ALL_CHANNELS;

    [[nodiscard]] bool isValid() const noexcept;

    /// Calls `action(index, samples)` for each of these frames, with the samples of it that belong to the target.
    template <typename Action>
    void forEachFrame(std::size_t firstFrame, std::size_t frames, Action action) const noexcept {
        const std::size_t channels = channelCount;
        const bool isAll = channel == HAPTOFLOW_ALL_CHANNELS;
        const std::size_t width = isAll ? channels : 1;
        float* sample = interleaved + firstFrame * channels + (isAll ? 0 : static_cast<std::size_t>(channel));
        for (std::size_t frame = 0; frame < frames; ++frame, sample += channels) {
            action(frame, std::span(sample, width));
        }
    }
};

// RealtimeSanitizer checks that functions with this attribute, and their callees, do only what an audio callback may
// do.
#if defined(__has_cpp_attribute)
#if __has_cpp_attribute(clang::nonblocking)
#define HAPTOFLOW_NONBLOCKING [[clang::nonblocking]]
#endif
#endif
#ifndef HAPTOFLOW_NONBLOCKING
#define HAPTOFLOW_NONBLOCKING
#endif

/// Renders the voice into a valid target; writes zeros if there is no voice, or if another thread renders it.
/// Wait-free, for the audio callback.
[[nodiscard]] haptoflow_status renderInto(const VoiceTable::Use& use, const ChannelTarget& target,
                                          double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING;

/// The same for the sum of several voices, limited as a whole. Sets a handle to 0 whose voice has ended, and leaves out
/// a voice that another thread renders (HAPTOFLOW_BUSY).
[[nodiscard]] haptoflow_status renderSum(VoiceTable& table, std::span<haptoflow_voice> voices,
                                         const ChannelTarget& target,
                                         double sampleRateHz) noexcept HAPTOFLOW_NONBLOCKING;

}  // namespace haptoflow::capi
