#pragma once

#include "engine/silence.hpp"
#include "engine/voice.hpp"
#include "engine/voice_channels.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>

namespace haptoflow::engine {

/// The part of a voice that runs in the audio callback: takes the newest contact and corrections, decides whether the
/// voice sounds, and renders. No allocation, no lock, no system call; bounded time. Used by one thread at a time.
///
/// `silence_` is the state: none while the texture sounds, otherwise the reason for its silence. It is decided at the
/// beginning of each block. Within a block, it changes only if the contact becomes stale or a tap ends.
class VoiceRenderer {
public:
    /// Duration of a tap that began and ended between two states.
    static constexpr double tapSeconds = 0.01;

    /// `workerAlive` becomes false when the worker thread has ended; the voice then falls silent. `key` is that of the
    /// voice's numbers, `skeleton` as for Voice. Allocates. Throws std::invalid_argument for a rate outside 8-192 kHz
    /// or a full scale that is not above 0.
    VoiceRenderer(VoiceChannels& channels, const std::atomic<bool>& workerAlive, double outputRateHz,
                  float fullScaleMps2, const skeleton::NoiseKey& key,
                  std::shared_ptr<const skeleton::Skeleton> skeleton = nullptr);

    /// Writes the next samples, +-1 unless they are part of a sum. At a new rate, the voice fades and stays silent
    /// until the worker has made an output stage; a touch that still lasts then resumes. At a rate outside 8-192 kHz it
    /// stays silent and counts the block.
    void render(std::span<float> out, double rateHz, Limit limit = Limit::voice) noexcept;
    /// See Voice::limitSum.
    void limitSum(std::span<float> sum, float ceiling) noexcept { voice_.limitSum(sum, ceiling); }

    [[nodiscard]] const Voice& voice() const noexcept { return voice_; }
    /// Null for none. See Voice::setSink.
    void setSink(WaveformSink* sink) noexcept { voice_.setSink(sink); }

private:
    [[nodiscard]] bool isSounding() const noexcept { return silence_ == Silence::none; }
    /// Whether effects may sound; the texture may rest.
    [[nodiscard]] bool maySound() const noexcept { return isSounding() || silence_ == Silence::rest; }
    /// Silent only until the worker has made an output stage.
    [[nodiscard]] bool waitsForRate() const noexcept {
        return silence_ == Silence::rate && channels_.isRateSupported.load(std::memory_order_relaxed);
    }
    [[nodiscard]] const PublishedContact& contact() const noexcept { return channels_.toAudio.current().contact; }
    void readContact() noexcept;
    void applyContact() noexcept;
    void readControls() noexcept;
    void readPanic() noexcept;
    void noteRate(double rateHz) noexcept;
    [[nodiscard]] std::size_t framesUntilStale(std::size_t frames) const noexcept;
    [[nodiscard]] SoundConditions conditions(double rateHz) const noexcept;
    void decide(double rateHz) noexcept;
    [[nodiscard]] Silence reportedSilence(double rateHz) const noexcept;
    void begin() noexcept;
    [[nodiscard]] double samplesAhead() const noexcept;
    void followContact() noexcept;
    void takeEvents(std::size_t frames) noexcept;
    void startWaiting() noexcept;
    void schedule(const ContactEvent& event, std::size_t frames) noexcept;
    void start(const ContactEvent& event) noexcept;
    void renderWithEvents(std::span<float> out) noexcept;
    void notePeriod(double sinceLastSeconds, std::uint64_t states) noexcept;
    void followRelief() noexcept;
    void readClip() noexcept;
    void readSignal() noexcept;
    void noteSignalTransition(SignalTransitions& transitions) noexcept;
    void takeProcessors() noexcept;
    void reportExposure() noexcept;
    void fallSilent(Silence reason) noexcept;
    void takeCorrections() noexcept;
    void requestOutput(double rateHz) noexcept;
    void sound(std::span<float> out) noexcept;
    void soundUntilStale(std::span<float> out) noexcept;
    void noteBlock(std::size_t frames) noexcept;
    void report(bool sounded) noexcept;

    VoiceChannels& channels_;
    const std::atomic<bool>& workerAlive_;
    double fullScaleMps2_;
    Voice voice_;

    Silence silence_ = Silence::rest;
    // Increases by 1 at each onset and each resumption, so that corrections of earlier streams are dropped.
    std::uint64_t stream_ = 0;
    skeleton::NoiseKey key_;
    // PublishedContact::updates of the contact that the waveform follows.
    std::uint64_t followed_ = 0;
    std::uint64_t reliefUpdate_ = 0;
    double publishedSeconds_ = 0.0;
    double statePeriodSeconds_ = 0.0;
    std::uint32_t playedOnset_ = 0;
    std::uint64_t tapFramesLeft_ = 0;

    // Last value of ContactEvent::number, and the values of PublishedContact::updates before this block's message and
    // in it.
    std::uint64_t takenEvent_ = 0;
    std::uint64_t updatesBefore_ = 0;
    std::uint64_t updates_ = 0;
    // The contact events of this block that have not begun yet, and the frames of the block rendered so far.
    struct DueEvent {
        std::size_t frame = 0;
        const ContactEvent* event = nullptr;
    };
    std::array<DueEvent, ContactEventList::capacity> due_{};
    std::size_t dueCount_ = 0;
    std::size_t dueNext_ = 0;
    std::size_t framesRendered_ = 0;
    // How much earlier than by its place a contact event begins, and the place of the last event; in frames of this
    // block, negative for an earlier block.
    std::int64_t advanceFrames_ = 0;
    std::int64_t lastPlace_ = std::numeric_limits<std::int32_t>::min();
    // The strongest impact and the strongest edge since the device changed to a rate that the worker prepares, and the
    // seconds since the first of them.
    std::array<std::optional<ContactEvent>, 2> waiting_{};
    double waitedSeconds_ = 0.0;

    effects::SignalSettings signal_;
    // ContactState::isMoving at the last block.
    bool wasMoving_ = false;

    bool hasContact_ = false;
    std::uint64_t contactAgeFrames_ = 0;
    Staleness staleness_;

    std::uint32_t seenPanics_ = 0;
    std::uint64_t silencedTouch_ = 0;
    // After a panic, until the block that ends in silence has been written.
    bool stopsWithBlock_ = false;

    std::uint64_t takenSequence_ = 0;
    std::array<std::int64_t, CorrectionQueue::capacity> headAtTake_{};
    // Longest block of the present window and of the one before, in waveform samples at a reading rate of 1.
    std::array<std::int64_t, 2> longestBlock_{};
    double blockPosition_ = 0.0;
    double blockSeconds_ = 0.0;
    int blocksNoted_ = 0;
    bool reportedRunning_ = false;
    bool reportedGuard_ = false;
};

}  // namespace haptoflow::engine
