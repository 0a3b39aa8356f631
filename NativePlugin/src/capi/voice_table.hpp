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
#include <utility>

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
/// lookup needs no lock and a destroyed voice is detected. Destroying a voice waits for its users.
class VoiceTable {
public:
    static constexpr std::size_t capacity = HAPTOFLOW_MAXIMUM_VOICES;
    /// Time limit of a fade: the longest common block, 1024 frames at 24 kHz, and 5 ms.
    static constexpr std::chrono::milliseconds fadeLimit{48};

    /// A user's reference to a voice; null if the handle is not open. Wait-free.
    class Use {
    public:
        Use() = default;
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;
        Use(Use&& other) noexcept : users_(std::exchange(other.users_, nullptr)), voice_(other.voice_) {}
        Use& operator=(Use&&) = delete;
        ~Use() {
            if (users_ != nullptr) {
                users_->fetch_sub(1, std::memory_order_release);
            }
        }
        [[nodiscard]] OpenVoice* get() const noexcept { return voice_; }
        [[nodiscard]] OpenVoice* operator->() const noexcept { return voice_; }
        [[nodiscard]] explicit operator bool() const noexcept { return voice_ != nullptr; }

    private:
        friend class VoiceTable;
        Use(std::atomic<std::uint32_t>* users, OpenVoice* voice) noexcept : users_(users), voice_(voice) {}

        std::atomic<std::uint32_t>* users_ = nullptr;
        OpenVoice* voice_ = nullptr;
    };

    /// Throws std::invalid_argument if all slots are in use.
    [[nodiscard]] haptoflow_voice open(std::unique_ptr<OpenVoice> voice);
    /// Waits until the voice has faded and has no users; at most `fadeLimit` for the fade, because nobody may be
    /// rendering it. Returns false if the handle is not open.
    bool close(haptoflow_voice handle);
    /// Closes all voices of an engine with a common fade.
    void closeAll(const engine::LiveEngine& engine);

    [[nodiscard]] Use use(haptoflow_voice handle) noexcept;
    /// The voice in a slot, if there is one.
    [[nodiscard]] Use useAt(std::size_t place) noexcept;
    /// The slot of an open handle; capacity otherwise.
    [[nodiscard]] std::size_t placeOf(haptoflow_voice handle) const noexcept;

private:
    struct Place {
        // The handle, or 0 while the slot is free.
        std::atomic<haptoflow_voice> handle{0};
        std::atomic<std::uint32_t> users{0};
        std::unique_ptr<OpenVoice> voice;
        std::uint64_t generation = 0;
    };

    static void fadeOut(std::span<Place* const> places);
    static void remove(Place& place);

    std::mutex mutex_;
    std::array<Place, capacity> places_;
};

[[nodiscard]] VoiceTable& voices() noexcept;

}  // namespace haptoflow::capi
