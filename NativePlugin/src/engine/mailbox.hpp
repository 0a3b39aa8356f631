#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace haptoflow::engine {

/// Passes the newest message from one writing to one reading thread through a triple buffer. Both sides are wait-free,
/// a message is never read half-written, and a message that was not fetched is replaced by the next. The message type
/// must not allocate when assigned.
template <typename Message>
class Mailbox {
public:
    /// Writer: the message to fill. It contains an old message, so every field must be written.
    [[nodiscard]] Message& draft() noexcept { return slots_[writing_]; }
    /// Writer: publishes the draft as the newest message.
    void post() noexcept {
        const auto offered = static_cast<std::uint8_t>(writing_ | freshBit);
        writing_ = static_cast<std::uint8_t>(exchanged_.exchange(offered, std::memory_order_acq_rel) & indexBits);
    }

    /// Reader: fetches the newest message. Returns false if there is none since the last fetch.
    bool fetch() noexcept {
        if ((exchanged_.load(std::memory_order_relaxed) & freshBit) == 0) {
            return false;
        }
        reading_ = static_cast<std::uint8_t>(exchanged_.exchange(reading_, std::memory_order_acq_rel) & indexBits);
        return true;
    }
    /// Reader: the message fetched last; default-constructed before the first fetch.
    [[nodiscard]] const Message& current() const noexcept { return slots_[reading_]; }

private:
    static constexpr std::uint8_t indexBits = 3;
    static constexpr std::uint8_t freshBit = 4;

    std::array<Message, 3> slots_{};
    std::uint8_t writing_ = 0;
    std::uint8_t reading_ = 1;
    std::atomic<std::uint8_t> exchanged_{2};
};

/// What a network adds to the stream for 200 samples, on its way from the worker to the callback.
struct Correction {
    /// Number of the correction among the voice's corrections, from 1.
    std::uint64_t sequence = 0;
    /// The stream that it corrects (from an onset to its end); a correction of another stream is dropped.
    std::uint64_t stream = 0;
    /// The sample in waveform time at which it takes over.
    std::int64_t start = 0;
    /// In unit scale: m/s^2 divided by the level.
    std::array<float, inference::segmentSamples> unit{};
};

/// A queue of corrections from one writing to one reading thread, wait-free on both sides. A full queue rejects new
/// ones and never overwrites queued ones, because later ones continue them.
class CorrectionQueue {
public:
    static constexpr std::size_t capacity = 8;

    /// Writer: appends a copy. Returns false if the queue is full.
    [[nodiscard]] bool push(const Correction& correction) noexcept {
        const std::uint64_t written = written_.load(std::memory_order_relaxed);
        if (written - read_.load(std::memory_order_acquire) == capacity) {
            return false;
        }
        slots_[written % capacity] = correction;
        written_.store(written + 1, std::memory_order_release);
        return true;
    }
    /// Writer: number of free slots.
    [[nodiscard]] std::size_t room() const noexcept {
        return capacity - static_cast<std::size_t>(written_.load(std::memory_order_relaxed) -
                                                   read_.load(std::memory_order_acquire));
    }

    /// Reader: the oldest correction, or null if the queue is empty.
    [[nodiscard]] const Correction* front() const noexcept {
        const std::uint64_t read = read_.load(std::memory_order_relaxed);
        return read == written_.load(std::memory_order_acquire) ? nullptr : &slots_[read % capacity];
    }
    /// Reader: removes the oldest. Only after `front` returned one.
    void pop() noexcept { read_.store(read_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

private:
    std::array<Correction, capacity> slots_{};
    std::atomic<std::uint64_t> written_{0};
    std::atomic<std::uint64_t> read_{0};
};

/// Hands objects from the thread that makes and frees them to one that may do neither. The user takes the newest and
/// gives back the one that it replaced; until that is collected, it takes no other. Wait-free on both sides.
template <typename Object>
class Supply {
public:
    Supply() = default;
    Supply(const Supply&) = delete;
    Supply& operator=(const Supply&) = delete;
    ~Supply() {
        delete fresh_.load();
        delete used_.load();
    }

    /// Maker: offers an object in place of one that was not taken.
    void offer(std::unique_ptr<Object> made) noexcept {
        delete fresh_.exchange(made.release(), std::memory_order_acq_rel);
    }
    /// Maker: frees what the user gave back.
    void collect() noexcept { delete used_.exchange(nullptr, std::memory_order_acq_rel); }
    /// Any thread: whether something waits to be collected.
    [[nodiscard]] bool hasUsed() const noexcept { return used_.load(std::memory_order_acquire) != nullptr; }

    /// User: the newest object, or null.
    [[nodiscard]] std::unique_ptr<Object> take() noexcept {
        // The exchange is costly. Only one thread takes, so a plain load tells it when nothing waits.
        Object* const waiting = fresh_.load(std::memory_order_relaxed);
        return std::unique_ptr<Object>(waiting == nullptr ? nullptr
                                                          : fresh_.exchange(nullptr, std::memory_order_acq_rel));
    }
    /// User: only while nothing waits to be collected.
    void giveBack(std::unique_ptr<Object> used) noexcept { used_.store(used.release(), std::memory_order_release); }

private:
    std::atomic<Object*> fresh_{nullptr};
    std::atomic<Object*> used_{nullptr};
};

}  // namespace haptoflow::engine
