#pragma once

#include "dsp/tone_cepstrum.hpp"
#include "effects/signal.hpp"
#include "engine/blend_balance.hpp"
#include "engine/level_request.hpp"
#include "engine/mailbox.hpp"
#include "engine/output_stage.hpp"
#include "engine/processor_settings.hpp"
#include "engine/rib_phase.hpp"
#include "engine/segment_queue.hpp"
#include "engine/silence.hpp"
#include "engine/waveform_timeline.hpp"
#include "inference/segment_generator.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>

namespace haptoflow::engine {

/// The newest blow of a kind.
struct BlowMessage {
    /// One more at each blow.
    std::uint32_t counter = 0;
    float speedMps = 0.0F;
    effects::ImpactResponse response{};
};

/// What the callback has to know of a contact.
struct AudioMessage {
    /// One more at each onset: touch-down, or sliding resumed.
    std::uint32_t onset = 0;
    /// ContactFollower::touches: a panic silences a touch, however often sliding resumes in it.
    std::uint64_t touch = 0;
    bool sliding = false;
    float levelGain = 1.0F;
    double readingRate = 1.0;
    /// The seed in m/s^2 for the newest state that slid, in every message: an onset survives being overwritten, and
    /// what resumes within a touch begins with the sound of the state that it resumes with.
    std::array<float, WaveformTimeline::seedSamples> seedMps2{};
    SeedRibs seedRibs{};
    /// In every message: a landing between two frames survives being overwritten.
    BlowMessage impact;
    BlowMessage edge;
    bool hasTone = false;
    dsp::ToneKernel tone{};
    /// Touches and moves fast enough for a signal, and since when that, or the opposite, is so: VoiceChannels::clock.
    bool isMoving = false;
    double movingSinceSeconds = 0.0;
};

/// What the worker has to know of a contact.
struct WorkerMessage {
    std::uint32_t onset = 0;
    bool sliding = false;
    /// How many of the states so far slid, this one included: a sliding state is generated for once.
    std::uint64_t slides = 0;
    std::array<float, inference::embeddingSize> embedding{};
    /// vx, vy in m/s and force in N, inside the trained range.
    std::array<float, 3> motion{};
    double readingRate = 1.0;
    LevelRequest level;
    BlendParts blend;
};

/// Where a voice's playback stands, as the callback left it at the end of a block.
struct Playhead {
    /// Counts onsets as they were played; 0 before the first.
    std::uint64_t stream = 0;
    /// AudioMessage::onset of that stream.
    std::uint32_t onset = 0;
    /// The head when that stream began, and the ribs of the seed that it began with.
    std::int64_t streamStart = 0;
    SeedRibs seedRibs{};
    /// False while nothing is read: the clock stands still.
    bool running = false;
    /// Sequence of the newest segment that the callback took or dropped, and for each of the last ones, at its sequence
    /// modulo the number of them, the head when it did.
    std::uint64_t takenSequence = 0;
    std::array<std::int64_t, SegmentQueue::capacity> headAtTake{};
    /// The most waveform samples that one of the last blocks consumes at a reading rate of 1.
    std::int64_t blockAdvance = 0;
    TimelineView timeline;
};

/// Commands to the callback that are neither contacts nor segments. Any thread sets them; they last until changed.
struct VoiceControls {
    std::atomic<float> strength{1.0F};
    /// Largest magnitude of the output, 0 to 1.
    std::atomic<float> ceiling{1.0F};
    std::atomic<bool> muted{false};
    std::atomic<bool> paused{false};
    /// Fades the voice for good, whatever its user wants of it.
    std::atomic<bool> closing{false};
    /// One more at each panic. Set by VoiceChannels::panic.
    std::atomic<std::uint32_t> panics{0};
    /// The newest touch at the newest panic: it and all before it stay silent.
    std::atomic<std::uint64_t> silencedTouch{0};
    /// Of the delay, where the voice has one: 0 to 0.5 s.
    std::atomic<double> delaySeconds{0.0};
    /// What sounds instead of texture, impact and edge, where it is set.
    std::atomic<effects::SignalSettings> signal{};
    static_assert(std::atomic<effects::SignalSettings>::is_always_lock_free);
    /// For the exposure guard: m/s^2 at the hand for each m/s^2 of the signal.
    std::atomic<double> actuatorGain{1.0};
};

/// EffectFigures::OfKind for any thread to read.
struct EffectCounters {
    std::atomic<std::uint64_t> prepared{0};
    std::atomic<std::uint64_t> runs{0};
    std::atomic<std::uint64_t> samples{0};
    std::atomic<std::uint64_t> nanoseconds{0};
    std::atomic<std::uint64_t> events{0};
};

/// How often a contact state turned a signal on, or off, and what passed from that state to the output's frame where
/// the change begins. One writer, the callback; any thread reads.
struct SignalTurns {
    std::atomic<std::uint64_t> count{0};
    std::atomic<double> lastSeconds{0.0};
    std::atomic<double> meanSeconds{0.0};

    void note(double seconds) noexcept;
};

/// What a voice has done; every counter only grows. Any thread reads.
struct VoiceCounters {
    /// By effects::EffectKind; of the texture there is nothing here, the other counters tell of it.
    std::array<EffectCounters, effects::effectKinds> effects{};
    SignalTurns signalStarts;
    SignalTurns signalStops;
    /// What the newest contact state asks for, and the processors that the voice has.
    std::atomic<effects::EffectMask> askedFor{0};
    std::atomic<std::uint64_t> updates{0};
    std::atomic<std::uint64_t> onsets{0};
    /// How often a touch sounded again after a silence within it: pause, mute, a rate change, missing states.
    std::atomic<std::uint64_t> resumptions{0};
    std::atomic<std::uint64_t> taps{0};
    /// Segments generated.
    std::atomic<std::uint64_t> inferences{0};
    /// What they took; voices that share a run share its time.
    std::atomic<std::uint64_t> inferenceNanoseconds{0};
    /// Touching updates for which nothing was generated: no sliding, no playback, or a newer update came first.
    std::atomic<std::uint64_t> skipped{0};
    /// Runs that failed; the running segment went on.
    std::atomic<std::uint64_t> failures{0};
    /// Blocks in which a sounding voice wanted samples that no segment covered.
    std::atomic<std::uint64_t> underruns{0};
    /// Segments that took over later than planned, and segments that came too late altogether or for an earlier touch.
    std::atomic<std::uint64_t> late{0};
    std::atomic<std::uint64_t> dropped{0};
    /// Fields of contact states that had to be made finite and physical.
    std::atomic<std::uint64_t> sanitised{0};
    std::atomic<std::uint64_t> staleStops{0};
    std::atomic<std::uint64_t> nonFiniteSamples{0};
    std::atomic<std::uint64_t> limitedSamples{0};
    std::atomic<std::uint64_t> renderedFrames{0};
    std::atomic<std::uint64_t> rateChanges{0};
    /// Blocks that a device asked for at a rate outside 8-192 kHz.
    std::atomic<std::uint64_t> unsupportedRateBlocks{0};
    /// Waveform samples by which a new segment leads the read head.
    std::atomic<std::uint32_t> leadSamples{0};
};

/// Of the process's steady clock, which every thread reads without entering the kernel.
[[nodiscard]] inline double steadySeconds() noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Everything that publisher, worker and callback of one voice share. Each part has one writer and one reader.
struct VoiceChannels {
    Mailbox<AudioMessage> toAudio;
    Mailbox<WorkerMessage> toWorker;
    Mailbox<Playhead> playhead;
    SegmentQueue segments;
    VoiceControls controls;
    VoiceCounters counters;
    /// Where publisher and callback read the time.
    double (*clock)() noexcept = steadySeconds;

    /// Whether the newest block ended with anything but silence. Set by the callback.
    std::atomic<bool> audible{false};
    /// Why the newest block is silent, and the device's rate at it. Set by the callback.
    std::atomic<Silence> silence{Silence::rest};
    std::atomic<double> deviceRateHz{0.0};
    std::atomic<bool> isRateSupported{true};

    /// The newest touch that the publisher has seen. Set by the publisher before it posts the message.
    std::atomic<std::uint64_t> publishedTouch{0};
    /// Silences what has been published so far, and nothing that is published later. Any thread but the callback's.
    void panic() noexcept;
    /// Changes what the voice asks for, where `change` says that it has; the worker then makes it. Any thread but the
    /// callback's. Returns whether there is something to make.
    bool changeProcessors(const std::function<bool(ProcessorSettings&)>& change);

    /// The callback asks for an output stage of this rate; 0 when it has what it needs.
    std::atomic<double> wantedRateHz{0.0};
    /// Made by the worker, taken by the callback; and the one it replaced, for the worker to delete.
    std::atomic<OutputStage*> freshOutput{nullptr};
    std::atomic<OutputStage*> usedOutput{nullptr};

    /// What the voice asks for. Set by any thread but the callback's, under the mutex.
    std::mutex processorMutex;
    ProcessorSettings processorSettings;
    /// ProcessorSettings::version, for the callback, and whether it has others or none.
    std::atomic<std::uint64_t> wantedProcessors{0};
    std::atomic<bool> lacksProcessors{false};
    /// The rate that the callback's stage was made for.
    std::atomic<double> stageRateHz{0.0};
    /// ExposureReport of the newest block. Set by the callback.
    std::atomic<effects::ExposureReason> exposureReason{effects::ExposureReason::none};
    std::atomic<double> exposureGain{1.0};
    std::atomic<double> exposureShortTermMps2{0.0};
    std::atomic<double> exposureDailyMps2{0.0};
    std::atomic<double> exposureLoweredSeconds{0.0};
    /// Made by the worker, as output stages are.
    std::atomic<Processors*> freshProcessors{nullptr};
    std::atomic<Processors*> usedProcessors{nullptr};

    VoiceChannels() = default;
    VoiceChannels(const VoiceChannels&) = delete;
    VoiceChannels& operator=(const VoiceChannels&) = delete;
    ~VoiceChannels() {
        delete freshOutput.load();
        delete usedOutput.load();
        delete freshProcessors.load();
        delete usedProcessors.load();
    }
};

inline void SignalTurns::note(double seconds) noexcept {
    const std::uint64_t turns = count.load(std::memory_order_relaxed) + 1;
    const double before = meanSeconds.load(std::memory_order_relaxed);
    lastSeconds.store(seconds, std::memory_order_relaxed);
    meanSeconds.store(before + (seconds - before) / static_cast<double>(turns), std::memory_order_relaxed);
    count.store(turns, std::memory_order_release);
}

inline bool VoiceChannels::changeProcessors(const std::function<bool(ProcessorSettings&)>& change) {
    const std::lock_guard lock(processorMutex);
    if (!change(processorSettings)) {
        return false;
    }
    wantedProcessors.store(++processorSettings.version, std::memory_order_release);
    lacksProcessors.store(true, std::memory_order_release);
    return true;
}

inline void VoiceChannels::panic() noexcept {
    const std::uint64_t touch = publishedTouch.load(std::memory_order_acquire);
    std::uint64_t silenced = controls.silencedTouch.load(std::memory_order_relaxed);
    while (silenced < touch && !controls.silencedTouch.compare_exchange_weak(silenced, touch)) {
    }
    controls.panics.fetch_add(1, std::memory_order_release);
}

}  // namespace haptoflow::engine
