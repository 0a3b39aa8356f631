#pragma once

#include "engine/silence.hpp"
#include "engine/voice.hpp"
#include "engine/voice_channels.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// The callback's end of a voice: takes the newest contact, commits segments, decides whether the voice sounds,
/// renders. Wait-free: no allocation, no lock, no system call, nothing unbounded. One thread at a time.
///
/// Its state is `silence_`: none while the texture sounds, else the reason why it does not. A block begins with one
/// decision between the two; within a block only a contact that goes stale and a tap that ends change it.
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
    /// worker has made one; a touch that still goes on then resumes. At a rate outside 8-192 kHz no stage can be made:
    /// it stays silent and counts the block.
    void render(std::span<float> out, double rateHz) noexcept;

    [[nodiscard]] const Voice& voice() const noexcept { return voice_; }
    /// Null for none. See Voice::setSink.
    void setSink(WaveformSink* sink) noexcept { voice_.setSink(sink); }

private:
    [[nodiscard]] bool isSounding() const noexcept { return silence_ == Silence::none; }
    void readContact() noexcept;
    void readControls() noexcept;
    void readPanic() noexcept;
    void noteRate(double rateHz) noexcept;
    [[nodiscard]] std::size_t framesUntilStale(std::size_t frames) const noexcept;
    [[nodiscard]] SoundConditions conditions(double rateHz) const noexcept;
    void decide(double rateHz) noexcept;
    void begin() noexcept;
    void readBlows() noexcept;
    void readSignal() noexcept;
    void noteSignalTurn(SignalTurns& turns) noexcept;
    void takeProcessors() noexcept;
    void reportEffects() noexcept;
    void reportExposure() noexcept;
    void fallSilent(Silence reason) noexcept;
    void takeSegments() noexcept;
    void requestOutput(double rateHz) noexcept;
    void sound(std::span<float> out) noexcept;
    void soundUntilStale(std::span<float> out) noexcept;
    void noteBlock(std::size_t frames) noexcept;
    void report(std::uint64_t uncoveredBefore, bool sounded) noexcept;

    VoiceChannels& channels_;
    const std::atomic<bool>& workerAlive_;
    Voice voice_;

    Silence silence_ = Silence::rest;
    // Generations of playback: one more at each touch and each resumption, so that older segments are dropped.
    std::uint64_t stream_ = 0;
    std::int64_t streamStart_ = 0;
    SeedRibs seedRibs_{};
    std::uint32_t playedOnset_ = 0;
    std::uint64_t tapFramesLeft_ = 0;
    // Of BlowMessage::counter.
    std::uint32_t seenImpacts_ = 0;
    std::uint32_t seenEdges_ = 0;

    effects::SignalSettings signal_;
    // AudioMessage::isMoving of the block before.
    bool wasMoving_ = false;

    bool hasContact_ = false;
    std::uint64_t contactAgeFrames_ = 0;

    std::uint32_t seenPanics_ = 0;
    std::uint64_t silencedTouch_ = 0;
    // A panic was noticed, and the block that has to end in silence is still to be written.
    bool stopsWithBlock_ = false;

    std::uint64_t takenSequence_ = 0;
    std::array<std::int64_t, SegmentQueue::capacity> headAtTake_{};
    // Of the blocks noted last and of those before them, in waveform samples at a reading rate of 1.
    std::array<std::int64_t, 2> longestBlock_{};
    int blocksNoted_ = 0;
    bool reportedRunning_ = false;
    bool reportedGuard_ = false;
    std::uint64_t reportedEffectChanges_ = 0;
};

}  // namespace haptoflow::engine
