#pragma once

#include "inference/segment_generator.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptoflow::engine {

/// A generated segment on its way from the worker to the callback.
struct QueuedSegment {
    /// Counts a voice's segments from 1.
    std::uint64_t sequence = 0;
    /// The stream (one onset to its end) that it continues; one of another stream is dropped.
    std::uint64_t stream = 0;
    /// The sample of waveform time at which it takes over.
    std::int64_t start = 0;
    /// m/s^2.
    std::array<float, inference::segmentSamples> samplesMps2{};
};

/// A queue of segments between one writing and one reading thread, wait-free on both sides. A full queue refuses:
/// segments already promised are never overwritten, because later ones go on from them.
class SegmentQueue {
public:
    static constexpr std::size_t capacity = 8;

    /// Writer: copies the segment in; false where the queue is full.
    [[nodiscard]] bool push(const QueuedSegment& segment) noexcept {
        const std::uint64_t written = written_.load(std::memory_order_relaxed);
        if (written - read_.load(std::memory_order_acquire) == capacity) {
            return false;
        }
        slots_[written % capacity] = segment;
        written_.store(written + 1, std::memory_order_release);
        return true;
    }
    /// Writer: how many more segments fit.
    [[nodiscard]] std::size_t room() const noexcept {
        return capacity - static_cast<std::size_t>(written_.load(std::memory_order_relaxed) -
                                                   read_.load(std::memory_order_acquire));
    }

    /// Reader: the oldest segment, or null.
    [[nodiscard]] const QueuedSegment* front() const noexcept {
        const std::uint64_t read = read_.load(std::memory_order_relaxed);
        return read == written_.load(std::memory_order_acquire) ? nullptr : &slots_[read % capacity];
    }
    /// Reader: lets go of the oldest segment; only after `front` returned one.
    void pop() noexcept { read_.store(read_.load(std::memory_order_relaxed) + 1, std::memory_order_release); }

private:
    std::array<QueuedSegment, capacity> slots_{};
    std::atomic<std::uint64_t> written_{0};
    std::atomic<std::uint64_t> read_{0};
};

}  // namespace haptoflow::engine
