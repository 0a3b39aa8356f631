#pragma once

#include "engine/voice.hpp"
#include "engine/voice_channels.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// The callback's end of a voice: takes the newest contact, commits segments, decides whether the voice sounds,
/// renders. Wait-free: no allocation, no lock, no system call, nothing unbounded. One thread at a time.
class VoiceRenderer {
public:
    /// A contact that nobody renewed for this long is stale: the stylus, or its application, is gone.
    static constexpr double staleSeconds = 0.1;
    /// How long a tap sounds whose end came along with its beginning.
    static constexpr double tapSeconds = 0.01;

    /// `workerAlive` is false once the thread that generates has ended; the voice then falls silent. Allocates. Throws
    /// std::invalid_argument for a rate outside 8-192 kHz or a full scale that is not above 0.
    VoiceRenderer(VoiceChannels& channels, const std::atomic<bool>& workerAlive, double outputRateHz,
                  float fullScaleMps2);

    /// Writes the next samples, +-1. At a rate that it has no output stage for, it fades and stays silent until the
    /// worker has made one, then goes on where it stopped.
    void render(std::span<float> out, double rateHz) noexcept;

    [[nodiscard]] const Voice& voice() const noexcept { return voice_; }
    /// Null for none. See Voice::setSink.
    void setSink(WaveformSink* sink) noexcept { voice_.setSink(sink); }

private:
    void readContact() noexcept;
    [[nodiscard]] std::size_t framesUntilStale(std::size_t frames) const noexcept;
    void goStale() noexcept;
    void decide(bool rateFits) noexcept;
    void begin() noexcept;
    void takeSegments() noexcept;
    void changeRate(double rateHz) noexcept;
    void sound(std::span<float> out) noexcept;
    void noteBlock(std::size_t frames) noexcept;
    void report(std::uint64_t uncoveredBefore, bool sounded) noexcept;

    VoiceChannels& channels_;
    const std::atomic<bool>& workerAlive_;
    Voice voice_;
    bool hasContact_ = false;
    std::uint64_t contactAgeFrames_ = 0;
    bool stale_ = false;
    bool sounding_ = false;
    bool interruptedByRate_ = false;
    std::uint64_t stream_ = 0;
    std::uint32_t playedOnset_ = 0;
    std::uint32_t seenPanics_ = 0;
    bool panicking_ = false;
    bool hasSilencedTouch_ = false;
    std::uint32_t silencedTouch_ = 0;
    std::uint64_t tapFramesLeft_ = 0;
    std::uint64_t takenSequence_ = 0;
    std::array<std::int64_t, SegmentQueue::capacity> headAtTake_{};
    // Of the blocks noted last and of those before them, in waveform samples at a reading rate of 1.
    std::array<std::int64_t, 2> longestBlock_{};
    int blocksNoted_ = 0;
    bool reportedRunning_ = false;
};

}  // namespace haptoflow::engine
