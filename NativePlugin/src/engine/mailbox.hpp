#pragma once

#include "engine/surface_phases.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// Passes the newest message from one writing to one reading thread through a triple buffer. Both sides are wait-free,
/// a message is never read half-written, and a message that was not fetched is replaced by the next. The message type
/// must not allocate when assigned.
template <typename Message>
class Mailbox {
public:
    Mailbox() = default;
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;
    ~Mailbox() = default;

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

/// A generated segment on its way from the worker to the callback.
struct QueuedSegment {
    /// Number of the segment among the voice's segments, from 1.
    std::uint64_t sequence = 0;
    /// The stream that it continues (from an onset to its end); a segment of another stream is dropped.
    std::uint64_t stream = 0;
    /// The sample in waveform time at which it takes over.
    std::int64_t start = 0;
    /// The contact state that it was made for (PublishedContact::updates), and that state's level
    /// (PublishedContact::levelMps2).
    std::uint64_t update = 0;
    float levelMps2 = 1.0F;
    /// Gain that balances a blend, which is part of the samples.
    float balance = 1.0F;
    /// The tip's way over the surface with this segment.
    SurfaceTrack track;
    /// m/s^2; and the sketch that the samples were refined from, if they were.
    std::array<float, inference::segmentSamples> samplesMps2{};
    bool hasSketch = false;
    std::array<float, inference::segmentSamples> sketchMps2{};
};

/// A queue of segments from one writing to one reading thread, wait-free on both sides. A full queue rejects new
/// segments and never overwrites queued ones, because later segments continue them.
class SegmentQueue {
public:
    static constexpr std::size_t capacity = 8;

    /// Writer: appends a copy of the segment. Returns false if the queue is full.
    [[nodiscard]] bool push(const QueuedSegment& segment) noexcept {
        const std::uint64_t written = written_.load(std::memory_order_relaxed);
        if (written - read_.load(std::memory_order_acquire) == capacity) {
            return false;
        }
        slots_[written % capacity] = segment;
        written_.store(written + 1, std::memory_order_release);
        return true;
    }
    /// Writer: number of free slots.
    [[nodiscard]] std::size_t room() const noexcept {
        return capacity - static_cast<std::size_t>(written_.load(std::memory_order_relaxed) -
                                                   read_.load(std::memory_order_acquire));
    }

    /// Reader: the oldest segment, or null if the queue is empty.
    [[nodiscard]] const QueuedSegment* front() const noexcept {
        const std::uint64_t read = read_.load(std::memory_order_relaxed);
        return read == written_.load(std::memory_order_acquire) ? nullptr : &slots_[read % capacity];
    }
    /// Reader: removes the oldest segment. Only after `front` returned one.
    void pop() noexcept { read_.store(read_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

private:
    std::array<QueuedSegment, capacity> slots_{};
    std::atomic<std::uint64_t> written_{0};
    std::atomic<std::uint64_t> read_{0};
};

}  // namespace haptoflow::engine
