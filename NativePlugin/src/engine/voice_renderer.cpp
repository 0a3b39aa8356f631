#include "engine/voice_renderer.hpp"

#include "dsp/denormals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::engine {
namespace {

void count(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
    counter.fetch_add(by, std::memory_order_relaxed);
}

}  // namespace

VoiceRenderer::VoiceRenderer(VoiceChannels& channels, const std::atomic<bool>& workerAlive, double outputRateHz,
                             float fullScaleMps2, const skeleton::NoiseKey& key,
                             std::shared_ptr<const skeleton::Skeleton> skeleton)
    : channels_(channels),
      workerAlive_(workerAlive),
      fullScaleMps2_(static_cast<double>(fullScaleMps2)),
      voice_(outputRateHz, fullScaleMps2, channels.counters.effects, std::move(skeleton)),
      key_(key) {}

void VoiceRenderer::render(std::span<float> out, double rateHz, Limit limit) noexcept {
    const dsp::ScopedFlushDenormals flush;
    voice_.setLimit(limit);
    // Read the contact first, so that settings made before it was published take effect with it.
    readContact();
    readControls();
    readPanic();
    noteRate(rateHz);
    noteBlock(out.size());
    takeProcessors();

    bool sounded = isSounding();
    if (stopsWithBlock_ && !out.empty()) {
        takeCorrections();
        voice_.renderStop(out);
        stopsWithBlock_ = false;
        fallSilent(Silence::panic);
    } else if (!stopsWithBlock_) {
        decide(rateHz);
        takeEvents(out.size());
        followRelief();
        readClip();
        readSignal();
        sounded = isSounding();
        followContact();
        takeCorrections();
        soundUntilStale(out);
    }
    contactAgeFrames_ += out.size();
    lastPlace_ -= static_cast<std::int64_t>(out.size());
    const double blockSeconds = dsp::isOutputRate(rateHz) ? static_cast<double>(out.size()) / rateHz : 0.0;
    waitedSeconds_ += blockSeconds;
    channels_.renderedSeconds.store(channels_.renderedSeconds.load(std::memory_order_relaxed) + blockSeconds,
                                    std::memory_order_relaxed);
    count(channels_.counters.renderedFrames, out.size());
    channels_.audible.store(!voice_.isSilent(), std::memory_order_release);
    channels_.silence.store(reportedSilence(rateHz), std::memory_order_relaxed);
    report(sounded && !out.empty());
}

Silence VoiceRenderer::reportedSilence(double rateHz) const noexcept {
    const VoiceControls& controls = channels_.controls;
    SoundConditions now = conditions(rateHz);
    now.isTurnedDown = controls.strength.load(std::memory_order_relaxed) == 0.0F ||
                       controls.ceiling.load(std::memory_order_relaxed) == 0.0F;
    if (silenceFor(now) == Silence::turnedDown) {
        return Silence::turnedDown;
    }
    // While the texture rests, an impact or a signal may still sound.
    return silence_ == Silence::rest && !voice_.isSilent() ? Silence::none : silence_;
}

void VoiceRenderer::noteBlock(std::size_t frames) noexcept {
    blockPosition_ = voice_.playPosition();
    blockSeconds_ = channels_.clock();
    // Devices may alternate between block lengths, so the maximum decreases only after many blocks.
    constexpr int window = 64;
    if (++blocksNoted_ >= window) {
        blocksNoted_ = 0;
        longestBlock_ = {0, longestBlock_[0]};
    }
    const double samples = static_cast<double>(frames) * inference::waveformRateHz / voice_.outputRateHz();
    longestBlock_[0] = std::max(longestBlock_[0], static_cast<std::int64_t>(std::ceil(samples)));
}

void VoiceRenderer::readContact() noexcept {
    updatesBefore_ = updates_;
    if (channels_.toAudio.fetch()) {
        hasContact_ = true;
        const std::uint64_t states = std::max<std::uint64_t>(1, contact().updates - updates_);
        const double sinceLast =
            static_cast<double>(contactAgeFrames_) / (static_cast<double>(states) * voice_.outputRateHz());
        staleness_.noteState(sinceLast);
        notePeriod(sinceLast, states);
        contactAgeFrames_ = 0;
        updates_ = contact().updates;
        // The message before, which kept the map that the tip follows, is the publisher's again.
        voice_.effects().keepRelief(channels_.toAudio.current().relief.get());
        applyContact();
    }
}

void VoiceRenderer::applyContact() noexcept {
    const ContactMessage& message = channels_.toAudio.current();
    const RangedMotion& ranged = message.contact.ranged;
    voice_.setRangeLaw(static_cast<float>(ranged.levelGain), ranged.readingRate);
    voice_.setTone(message.tone ? &*message.tone : nullptr);
}

void VoiceRenderer::readControls() noexcept {
    const VoiceControls& controls = channels_.controls;
    voice_.setStrength(controls.strength.load(std::memory_order_relaxed));
    voice_.setCeiling(controls.ceiling.load(std::memory_order_relaxed));
    signal_ = controls.signal.load(std::memory_order_relaxed);
    voice_.effects().setSignal(signal_);
    voice_.effects().setDelaySeconds(controls.delaySeconds.load(std::memory_order_relaxed));
    voice_.effects().setActuatorGain(controls.actuatorGain.load(std::memory_order_relaxed));
}

void VoiceRenderer::readPanic() noexcept {
    const std::uint32_t panics = channels_.controls.panics.load(std::memory_order_acquire);
    if (panics == seenPanics_) {
        return;
    }
    seenPanics_ = panics;
    silencedTouch_ = channels_.controls.silencedTouch.load(std::memory_order_relaxed);
    // A silent voice has nothing to stop, and a touch that began after the panic may sound at once.
    stopsWithBlock_ = stopsWithBlock_ || !voice_.isSilent();
}

void VoiceRenderer::noteRate(double rateHz) noexcept {
    const bool isSupported = dsp::isOutputRate(rateHz);
    channels_.deviceRateHz.store(rateHz, std::memory_order_relaxed);
    channels_.isRateSupported.store(isSupported, std::memory_order_relaxed);
    if (!isSupported) {
        count(channels_.counters.unsupportedRateBlocks);
        channels_.requestedRateHz.store(0.0, std::memory_order_release);
    }
}

std::size_t VoiceRenderer::framesUntilStale(std::size_t frames) const noexcept {
    if (!hasContact_) {
        return frames;
    }
    const auto limit = static_cast<std::uint64_t>(staleness_.seconds() * voice_.outputRateHz());
    return static_cast<std::size_t>(std::min<std::uint64_t>(frames, limit - std::min(limit, contactAgeFrames_)));
}

SoundConditions VoiceRenderer::conditions(double rateHz) const noexcept {
    const VoiceControls& controls = channels_.controls;
    const bool hasTexture = contact().sliding || contact().onset != playedOnset_ || tapFramesLeft_ > 0;
    return {.isTouched = signal_.isSet() ? contact().state.isMoving() : hasTexture,
            .isStale = framesUntilStale(1) == 0,
            .isMuted = controls.muted.load(std::memory_order_relaxed),
            .isPaused = controls.paused.load(std::memory_order_relaxed),
            .isPanicked = contact().touch <= silencedTouch_,
            .isRateServed = rateHz == voice_.outputRateHz(),
            .isClosing = controls.closing.load(std::memory_order_relaxed),
            .isWorkerAlive = workerAlive_.load(std::memory_order_acquire)};
}

void VoiceRenderer::decide(double rateHz) noexcept {
    Silence silence = silenceFor(conditions(rateHz));
    const bool isPreparable = dsp::isOutputRate(rateHz);
    if (silence == Silence::rate && isPreparable) {
        fallSilent(silence);
        if (!voice_.isSilent()) {
            return;
        }
        requestOutput(rateHz);
        silence = silenceFor(conditions(rateHz));
    }
    if (silence == Silence::none && signal_.isSet()) {
        silence = Silence::rest;
    }
    if (silence == Silence::none) {
        if (!isSounding() || contact().onset != playedOnset_) {
            begin();
        }
        return;
    }
    fallSilent(silence);
    // A touch that began and ended during a silence is not played later, unless the voice only waits for a rate.
    if (!contact().sliding && (silence != Silence::rate || !isPreparable)) {
        playedOnset_ = contact().onset;
    }
}

void VoiceRenderer::fallSilent(Silence reason) noexcept {
    if (isSounding()) {
        tapFramesLeft_ = 0;
        voice_.release();
        if (reason == Silence::stale) {
            count(channels_.counters.staleStops);
        }
    }
    if (reason != Silence::rest) {
        voice_.stop();
    }
    silence_ = reason;
}

void VoiceRenderer::begin() noexcept {
    count(contact().onset != playedOnset_ ? channels_.counters.onsets : channels_.counters.resumptions);
    ++stream_;
    playedOnset_ = contact().onset;
    silence_ = Silence::none;
    tapFramesLeft_ = contact().sliding ? 0 : static_cast<std::uint64_t>(tapSeconds * voice_.outputRateHz());
    if (!contact().sliding) {
        count(channels_.counters.taps);
    }
    applyContact();
    // The stream's clock begins with the block.
    blockPosition_ = static_cast<double>(voice_.waveform().head()) + static_cast<double>(voice_.samplesReadAhead());
    ++key_.segment;
    const ContactMessage& message = channels_.toAudio.current();
    voice_.begin(message.stream, samplesAhead(), key_, message.material.beginningUnit);
    followed_ = contact().updates;
}

double VoiceRenderer::samplesAhead() const noexcept {
    return channels_.samplesAhead(contact(), voice_.waveform().head(), blockPosition_, blockSeconds_);
}

void VoiceRenderer::followContact() noexcept {
    if (followed_ != contact().updates && isSounding() && contact().sliding) {
        followed_ = contact().updates;
        voice_.follow(channels_.toAudio.current().stream, samplesAhead());
    }
}

void VoiceRenderer::takeEvents(std::size_t frames) noexcept {
    dueCount_ = 0;
    dueNext_ = 0;
    framesRendered_ = 0;
    if (waitedSeconds_ > staleness_.seconds() || (!maySound() && !waitsForRate())) {
        // ContactEvents that occurred long ago or during another silence are not played later.
        waiting_ = {};
    }
    if (maySound()) {
        voice_.allowEffects();
        startWaiting();
    }
    const std::span<const ContactEvent> contactEvents = channels_.toAudio.current().contactEvents.all();
    if (contactEvents.empty() || contactEvents.back().number <= takenEvent_) {
        return;
    }
    // After a device has stopped for a while, the contact events of that time are not played all at once.
    const auto blockSamples = static_cast<double>(std::max(longestBlock_[0], longestBlock_[1]));
    const double oldestSeconds = staleness_.seconds() + 2.0 * blockSamples / inference::waveformRateHz;
    const double nowSeconds = channels_.isRealTime ? channels_.clock() : 0.0;
    for (const ContactEvent& event : contactEvents) {
        const bool isTooOld = channels_.isRealTime && nowSeconds - event.publishedSeconds > oldestSeconds;
        if (event.number <= takenEvent_ || isTooOld || signal_.isSet()) {
            continue;
        }
        if (maySound()) {
            schedule(event, frames);
        } else if (waitsForRate()) {
            std::optional<ContactEvent>& strongest = waiting_[event.kind == effects::EffectKind::edge ? 1 : 0];
            waitedSeconds_ = waiting_[0] || waiting_[1] ? waitedSeconds_ : 0.0;
            if (!strongest || strongest->speedMps < event.speedMps) {
                strongest = event;
            }
        }
    }
    takenEvent_ = contactEvents.back().number;
    channels_.takenEvent.store(takenEvent_, std::memory_order_release);
}

void VoiceRenderer::startWaiting() noexcept {
    for (std::optional<ContactEvent>& event : waiting_) {
        if (event) {
            start(*event);
        }
        event.reset();
    }
}

// States come evenly, so the place of a contact event's state among those published since the last block is its time in
// that block. Played by it, each event would be late by exactly a block. A event that follows no other therefore begins
// at once, and those after it keep their distance from it; the time gained is given up as soon as a contact event would
// have to begin before its block.
void VoiceRenderer::schedule(const ContactEvent& event, std::size_t frames) noexcept {
    const std::uint64_t states = updates_ - updatesBefore_;
    const std::uint64_t before = event.update > updatesBefore_ ? event.update - updatesBefore_ - 1 : 0;
    const std::uint64_t audible = framesUntilStale(frames);
    const auto place = states == 0 ? std::int64_t{0} : static_cast<std::int64_t>(before * audible / states);
    const auto apartFrames = static_cast<double>(place - lastPlace_);
    const bool followsNone = lastPlace_ < 0 && apartFrames > staleness_.seconds() * voice_.outputRateHz();
    advanceFrames_ = followsNone ? place : std::min(advanceFrames_, place);
    lastPlace_ = place;
    if (place == advanceFrames_) {
        start(event);
    } else {
        due_[dueCount_++] = {static_cast<std::size_t>(place - advanceFrames_), &event};
    }
}

void VoiceRenderer::start(const ContactEvent& event) noexcept {
    if (event.touch > silencedTouch_) {
        voice_.start(event.kind, static_cast<double>(event.speedMps), event.response);
    }
}

void VoiceRenderer::renderWithEvents(std::span<float> out) noexcept {
    while (dueNext_ < dueCount_ && due_[dueNext_].frame < framesRendered_ + out.size()) {
        const std::size_t until = due_[dueNext_].frame - framesRendered_;
        voice_.render(out.first(until));
        out = out.subspan(until);
        framesRendered_ += until;
        start(*due_[dueNext_].event);
        ++dueNext_;
    }
    voice_.render(out);
    framesRendered_ += out.size();
}

void VoiceRenderer::notePeriod(double sinceLastSeconds, std::uint64_t states) noexcept {
    const double publishedSeconds = contact().publishedSeconds;
    const double before = std::exchange(publishedSeconds_, publishedSeconds);
    statePeriodSeconds_ =
        channels_.isRealTime ? (publishedSeconds - before) / static_cast<double>(states) : sinceLastSeconds;
}

void VoiceRenderer::followRelief() noexcept {
    const ContactMessage& message = channels_.toAudio.current();
    if (!maySound() || std::exchange(reliefUpdate_, message.contact.updates) == message.contact.updates) {
        return;
    }
    if (message.relief == nullptr || message.contact.touch <= silencedTouch_) {
        voice_.followRelief({});
        return;
    }
    const ContactState& state = message.contact.state;
    effects::ReliefContact relief{.map = message.relief.get(),
                                  .speedMps = static_cast<double>(state.speedMps()),
                                  .forceNewtons = static_cast<double>(state.forceNewtons),
                                  .largestMps2 = static_cast<double>(state.reliefShare) * fullScaleMps2_,
                                  .stiffnessNewtonsPerMetre = message.reliefStiffness};
    relief.place = {static_cast<double>(state.reliefPlace[0]), static_cast<double>(state.reliefPlace[1])};
    relief.arrivalSeconds = statePeriodSeconds_;
    if (channels_.isRealTime) {
        // A state waits for the next block for up to its length.
        const double longest = static_cast<double>(std::max(longestBlock_[0], longestBlock_[1])) / dsp::waveformRateHz;
        relief.arrivalSeconds += longest - (blockSeconds_ - message.contact.publishedSeconds);
    }
    voice_.followRelief(relief);
}

void VoiceRenderer::readClip() noexcept {
    if (waitsForRate() || !channels_.clip.fetch()) {
        return;
    }
    // The message before, which kept the wave that sounds, is the publisher's again.
    const ClipMessage& message = channels_.clip.current();
    // A device that has stopped for a while does not play what was meant then.
    constexpr double oldestSeconds = 0.5;
    const bool isTooOld = channels_.isRealTime && channels_.clock() - message.publishedSeconds > oldestSeconds;
    if (message.wave == nullptr || !maySound() || isTooOld || message.panics != seenPanics_ || signal_.isSet()) {
        voice_.effects().clip().leave();
    } else {
        voice_.startClip(*message.wave, message.gain, message.isLoop);
    }
}

void VoiceRenderer::readSignal() noexcept {
    const bool isMoving = contact().state.isMoving();
    const bool hasChanged = std::exchange(wasMoving_, isMoving) != isMoving;
    // A silence also ends the signal, which restarts afterwards.
    if (!maySound()) {
        return;
    }
    const bool isWanted = signal_.isSet() && isMoving;
    if (isWanted == voice_.effects().isSignalOn()) {
        return;
    }
    if (isWanted) {
        voice_.beginSignal();
    } else {
        voice_.effects().endSignal();
    }
    if (hasChanged) {
        noteSignalTransition(isWanted ? channels_.counters.signalStarts : channels_.counters.signalStops);
    }
}

void VoiceRenderer::noteSignalTransition(SignalTransitions& transitions) noexcept {
    const double sinceSeconds = channels_.toAudio.current().movingSinceSeconds;
    transitions.note(std::max(0.0, channels_.clock() - sinceSeconds) + voice_.effects().delaySeconds());
}

void VoiceRenderer::takeProcessors() noexcept {
    const std::uint64_t wantedVersion = channels_.requestedProcessors.load(std::memory_order_acquire);
    const bool lacks = wantedVersion != voice_.effects().version();
    // Store only changes, because the worker reads other data on the same cache line.
    if (channels_.stageRateHz.load(std::memory_order_relaxed) != voice_.outputRateHz()) {
        channels_.stageRateHz.store(voice_.outputRateHz(), std::memory_order_release);
    }
    if (channels_.lacksProcessors.load(std::memory_order_relaxed) != lacks) {
        channels_.lacksProcessors.store(lacks, std::memory_order_release);
    }
    // Only one used set at a time waits for the worker to delete it.
    if (channels_.processors.hasUsed()) {
        return;
    }
    EffectStage& stage = voice_.effects();
    const bool isSilent = voice_.isSilent();
    if (isSilent) {
        stage.finishHandOver();
    }
    std::unique_ptr<Processors> used = stage.takeReplaced();
    if (used == nullptr && !stage.isHandingOver()) {
        std::unique_ptr<Processors> fresh = channels_.processors.take();
        if (fresh == nullptr) {
            return;
        }
        if (fresh->rateHz == voice_.outputRateHz()) {
            voice_.exchangeProcessors(std::move(fresh));
            if (isSilent) {
                // A silent voice needs no crossfade, and an impact in this block must keep its attack.
                stage.finishHandOver();
            }
        } else {
            used = std::move(fresh);
        }
    }
    channels_.processors.giveBack(std::move(used));
}

void VoiceRenderer::takeCorrections() noexcept {
    // The number is limited, so that a worker that keeps sending cannot hold up the callback.
    for (std::size_t taken = 0; taken < CorrectionQueue::capacity; ++taken) {
        const Correction* correction = channels_.corrections.front();
        if (correction == nullptr) {
            return;
        }
        takenSequence_ = correction->sequence;
        headAtTake_[takenSequence_ % headAtTake_.size()] = voice_.waveform().head();
        const bool isCurrent = isSounding() && correction->stream == stream_;
        const std::int64_t takeOver = isCurrent ? voice_.take(*correction) : -1;
        if (takeOver < 0) {
            count(channels_.counters.dropped);
        } else if (takeOver > correction->start) {
            count(channels_.counters.late);
        }
        channels_.corrections.pop();
    }
}

void VoiceRenderer::requestOutput(double rateHz) noexcept {
    // While the stage of the last change waits to be collected, the voice keeps its present one. The request makes the
    // next published state wake the worker.
    std::unique_ptr<OutputStage> stage = channels_.outputs.hasUsed() ? nullptr : channels_.outputs.take();
    const bool fits = stage != nullptr && stage->rateHz == rateHz;
    channels_.requestedRateHz.store(fits ? 0.0 : rateHz, std::memory_order_release);
    if (fits) {
        stage = voice_.exchangeOutput(std::move(stage));
        count(channels_.counters.rateChanges);
    }
    if (stage != nullptr) {
        channels_.outputs.giveBack(std::move(stage));
    }
}

void VoiceRenderer::soundUntilStale(std::span<float> out) noexcept {
    const std::size_t fresh = framesUntilStale(out.size());
    sound(out.first(fresh));
    if (fresh < out.size()) {
        if (!voice_.isSilent()) {
            fallSilent(Silence::stale);
        }
        sound(out.subspan(fresh));
    }
}

void VoiceRenderer::sound(std::span<float> out) noexcept {
    if (tapFramesLeft_ > 0) {
        const auto before = static_cast<std::size_t>(std::min<std::uint64_t>(out.size(), tapFramesLeft_));
        renderWithEvents(out.first(before));
        out = out.subspan(before);
        tapFramesLeft_ -= before;
        if (tapFramesLeft_ == 0 && !contact().sliding) {
            fallSilent(Silence::rest);
        }
    }
    renderWithEvents(out);
}

void VoiceRenderer::reportExposure() noexcept {
    const effects::ExposureGuard* guard = voice_.effects().exposureGuard();
    if (guard == nullptr && !reportedGuard_) {
        return;
    }
    reportedGuard_ = guard != nullptr;
    const effects::ExposureReport report = guard != nullptr ? guard->report() : effects::ExposureReport{};
    channels_.exposureReason.store(report.reason, std::memory_order_relaxed);
    channels_.exposureGain.store(report.gain, std::memory_order_relaxed);
    channels_.exposureShortTermMps2.store(report.shortTermMps2, std::memory_order_relaxed);
    channels_.exposureDailyMps2.store(report.dailyMps2, std::memory_order_relaxed);
    channels_.exposureLoweredSeconds.store(report.loweredSeconds, std::memory_order_relaxed);
}

void VoiceRenderer::report(bool sounded) noexcept {
    VoiceCounters& counters = channels_.counters;
    const Waveform& waveform = voice_.waveform();
    if (sounded && !waveform.isCorrected()) {
        count(voice_.hasSkeleton() ? counters.sketched : counters.underruns);
    }
    counters.nonFiniteSamples.store(voice_.limiter().nonFiniteCount(), std::memory_order_relaxed);
    counters.limitedSamples.store(voice_.limiter().limitedCount(), std::memory_order_relaxed);
    reportExposure();

    const bool running = isSounding();
    if (!running && !reportedRunning_) {
        return;
    }
    reportedRunning_ = running;
    Playhead& playhead = channels_.playhead.draft();
    playhead.stream = stream_;
    playhead.onset = playedOnset_;
    playhead.update = followed_;
    playhead.running = running;
    playhead.takenSequence = takenSequence_;
    playhead.headAtTake = headAtTake_;
    playhead.blockPosition = blockPosition_;
    playhead.blockSeconds = blockSeconds_;
    playhead.blockAdvance = std::max(longestBlock_[0], longestBlock_[1]);
    playhead.waveform = waveform;
    channels_.playhead.post();
}

}  // namespace haptoflow::engine
