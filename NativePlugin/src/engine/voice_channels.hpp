#pragma once

#include "effects/signal.hpp"
#include "engine/contact_messages.hpp"
#include "engine/effect_stage.hpp"
#include "engine/mailbox.hpp"
#include "engine/silence.hpp"
#include "engine/stream_parameters.hpp"
#include "engine/waveform.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace haptoflow::engine {

/// State of a voice's playback at the end of a block, written by the callback.
struct Playhead {
    /// Number of streams (onsets and resumptions) played so far.
    std::uint64_t stream = 0;
    /// PublishedContact::onset of the present stream.
    std::uint32_t onset = 0;
    /// PublishedContact::updates of the contact that the waveform follows.
    std::uint64_t update = 0;
    /// False while the waveform is not read and its clock stands still.
    bool running = false;
    /// Sequence number of the newest correction that the callback took or dropped, and the head at the time for each of
    /// the last ones, indexed by the sequence number modulo the capacity.
    std::uint64_t takenSequence = 0;
    std::array<std::int64_t, CorrectionQueue::capacity> headAtTake{};
    /// Maximum number of waveform samples that one of the last blocks consumes at a reading rate of 1.
    std::int64_t blockAdvance = 0;
    /// Voice::playPosition at the beginning of the block, and VoiceChannels::clock then.
    double blockPosition = 0.0;
    double blockSeconds = 0.0;
    Waveform waveform;
};

/// A wave that the callback plays beside the texture. Its slot of the mailbox keeps the wave, and the publisher frees
/// it.
struct ClipMessage {
    /// At effects::ClipSound::waveRateHz, in m/s^2; null to stop.
    std::shared_ptr<const std::vector<float>> wave{};
    float gain = 1.0F;
    bool isLoop = false;
    /// VoiceChannels::clock, and VoiceControls::panics, when it was published.
    double publishedSeconds = 0.0;
    std::uint32_t panics = 0;
};

/// Settings of the callback besides contacts and segments. Any thread may change them.
struct VoiceControls {
    /// Gain before the limiter, 0 to 1.
    std::atomic<float> strength{1.0F};
    /// Maximum magnitude of the output, 0 to 1.
    std::atomic<float> ceiling{1.0F};
    std::atomic<bool> muted{false};
    std::atomic<bool> paused{false};
    /// Silences the voice permanently.
    std::atomic<bool> closing{false};
    /// Increases by 1 at each panic. Set by VoiceChannels::panic.
    std::atomic<std::uint32_t> panics{0};
    /// The newest touch at the newest panic. It and all earlier touches stay silent.
    std::atomic<std::uint64_t> silencedTouch{0};
    /// Delay of a voice with the delay effect, 0 to 0.5 s.
    std::atomic<double> delaySeconds{0.0};
    /// Signal played instead of texture, impact and edge, if set.
    std::atomic<effects::SignalSettings> signal{};
    static_assert(std::atomic<effects::SignalSettings>::is_always_lock_free);
    /// For the exposure guard: m/s^2 at the hand per m/s^2 of the signal.
    std::atomic<double> actuatorGain{1.0};
};

/// Number of times that a contact state switched a signal on (or off), and the time from that state to the output frame
/// at which the change begins. Written by the callback; any thread reads.
struct SignalTransitions {
    std::atomic<std::uint64_t> count{0};
    std::atomic<double> lastSeconds{0.0};
    std::atomic<double> meanSeconds{0.0};

    void note(double seconds) noexcept {
        const std::uint64_t runs = count.load(std::memory_order_relaxed) + 1;
        const double before = meanSeconds.load(std::memory_order_relaxed);
        lastSeconds.store(seconds, std::memory_order_relaxed);
        meanSeconds.store(before + (seconds - before) / static_cast<double>(runs), std::memory_order_relaxed);
        count.store(runs, std::memory_order_release);
    }
};

/// Counters of a voice; none ever decreases. Any thread reads.
struct VoiceCounters {
    /// By effects::EffectKind, without the texture, which the other counters describe.
    EffectFigures effects{};
    SignalTransitions signalStarts;
    SignalTransitions signalStops;
    /// Effects of the newest contact state and processors of the voice.
    std::atomic<effects::EffectMask> requestedEffects{0};
    std::atomic<std::uint64_t> updates{0};
    std::atomic<std::uint64_t> onsets{0};
    /// Number of times that a touch sounded again after a silence within it: pause, mute, rate change, missing states.
    std::atomic<std::uint64_t> resumptions{0};
    std::atomic<std::uint64_t> taps{0};
    /// Impacts and edges that found no room among those that the callback had not taken yet.
    std::atomic<std::uint64_t> lostEvents{0};
    /// Segments generated.
    std::atomic<std::uint64_t> inferences{0};
    /// Time of their generation; the time of a run is divided among its voices.
    std::atomic<std::uint64_t> inferenceNanoseconds{0};
    /// Touching updates without a segment: no sliding, no playback, or a newer update came first.
    std::atomic<std::uint64_t> skipped{0};
    /// Failed runs; the running segment continued.
    std::atomic<std::uint64_t> failures{0};
    /// Blocks in which a sounding voice needed samples that no segment covered.
    std::atomic<std::uint64_t> underruns{0};
    /// Blocks in which a skeleton sounded without a network's segment: until the first one of a stream, and while
    /// inference is late or fails.
    std::atomic<std::uint64_t> sketched{0};
    /// Late segments, which took over later than planned; and dropped segments, which came too late or for an earlier
    /// touch.
    std::atomic<std::uint64_t> late{0};
    std::atomic<std::uint64_t> dropped{0};
    /// Changed fields of contact states (see sanitise).
    std::atomic<std::uint64_t> sanitised{0};
    std::atomic<std::uint64_t> staleStops{0};
    std::atomic<std::uint64_t> nonFiniteSamples{0};
    std::atomic<std::uint64_t> limitedSamples{0};
    std::atomic<std::uint64_t> renderedFrames{0};
    std::atomic<std::uint64_t> rateChanges{0};
    /// Blocks requested at a rate outside 8-192 kHz.
    std::atomic<std::uint64_t> unsupportedRateBlocks{0};
    /// Lead of the newest segment, in waveform samples.
    std::atomic<std::uint32_t> leadSamples{0};
};

/// Time of the steady clock, which every thread can read without entering the kernel.
[[nodiscard]] inline double steadySeconds() noexcept {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The data that publisher, worker and callback of one voice share.
struct VoiceChannels {
    Mailbox<ContactMessage> toAudio;
    Mailbox<ContactMessage> toWorker;
    Mailbox<Playhead> playhead;
    Mailbox<ClipMessage> clip;
    CorrectionQueue corrections;
    VoiceControls controls;
    VoiceCounters counters;
    /// Clock of publisher and callback.
    double (*clock)() noexcept = steadySeconds;
    /// False where states and blocks follow each other faster or slower than in real time: offline, without a worker.
    bool isRealTime = true;

    /// Samples from the publishing of `contact` to the sample `head`, in a block that began at `blockSeconds` of the
    /// clock with the sample `blockPosition`: see samplesSincePublished.
    [[nodiscard]] double samplesAhead(const PublishedContact& contact, std::int64_t head, double blockPosition,
                                      double blockSeconds) const noexcept {
        return samplesSincePublished(static_cast<double>(head) - blockPosition, contact.ranged.readingRate,
                                     isRealTime ? blockSeconds - contact.publishedSeconds : 0.0);
    }

    /// Whether the newest block did not end in silence. Set by the callback.
    std::atomic<bool> audible{false};
    /// Reason for the silence of the newest block, and the device's rate. Set by the callback.
    std::atomic<Silence> silence{Silence::rest};
    std::atomic<double> deviceRateHz{0.0};
    /// Time that was rendered so far. Set by the callback.
    std::atomic<double> renderedSeconds{0.0};
    std::atomic<bool> isRateSupported{true};

    /// ContactEvent::number of the newest event that the callback has taken. Set by the callback.
    std::atomic<std::uint64_t> takenEvent{0};

    /// The newest published touch. The publisher sets it before it posts the message.
    std::atomic<std::uint64_t> publishedTouch{0};
    /// Silences every touch published so far; later touches sound. Any thread except the callback's.
    void panic() noexcept {
        const std::uint64_t touch = publishedTouch.load(std::memory_order_acquire);
        std::uint64_t silenced = controls.silencedTouch.load(std::memory_order_relaxed);
        while (silenced < touch && !controls.silencedTouch.compare_exchange_weak(silenced, touch)) {
        }
        controls.panics.fetch_add(1, std::memory_order_release);
    }
    /// `change` edits the processor settings and returns whether they have changed; the worker then makes the
    /// processors. Returns the result of `change`. Any thread except the callback's.
    bool changeProcessors(const std::function<bool(ProcessorSettings&)>& change) {
        const std::lock_guard lock(processorMutex);
        if (!change(processorSettings)) {
            return false;
        }
        requestedProcessors.store(++processorSettings.version, std::memory_order_release);
        lacksProcessors.store(true, std::memory_order_release);
        return true;
    }

    /// Rate of the output stage that the callback requests; 0 if it needs none.
    std::atomic<double> requestedRateHz{0.0};
    /// From the worker to the callback.
    Supply<OutputStage> outputs;
    Supply<Processors> processors;

    /// Processor settings of the voice. Any thread except the callback's changes them under the mutex.
    std::mutex processorMutex;
    ProcessorSettings processorSettings;
    /// ProcessorSettings::version for the callback, and whether the callback's processors have another version.
    std::atomic<std::uint64_t> requestedProcessors{0};
    std::atomic<bool> lacksProcessors{false};
    /// Rate of the callback's output stage.
    std::atomic<double> stageRateHz{0.0};
    /// ExposureReport of the newest block. Set by the callback.
    std::atomic<effects::ExposureReason> exposureReason{effects::ExposureReason::none};
    std::atomic<double> exposureGain{1.0};
    std::atomic<double> exposureShortTermMps2{0.0};
    std::atomic<double> exposureDailyMps2{0.0};
    std::atomic<double> exposureLoweredSeconds{0.0};
};

}  // namespace haptoflow::engine
