#include "engine/voice_renderer.hpp"

#include "dsp/denormals.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {
namespace {

void count(std::atomic<std::uint64_t>& counter, std::uint64_t by = 1) noexcept {
    counter.fetch_add(by, std::memory_order_relaxed);
}

float unitRange(float value) noexcept {
    return std::isfinite(value) ? std::clamp(value, 0.0F, 1.0F) : 0.0F;
}

}  // namespace

VoiceRenderer::VoiceRenderer(VoiceChannels& channels, const std::atomic<bool>& workerAlive, double outputRateHz,
                             float fullScaleMps2)
    : channels_(channels), workerAlive_(workerAlive), voice_(outputRateHz, fullScaleMps2) {}

void VoiceRenderer::render(std::span<float> out, double rateHz) noexcept {
    const dsp::ScopedFlushDenormals flush;
    const VoiceControls& controls = channels_.controls;
    voice_.setStrength(unitRange(controls.strength.load(std::memory_order_relaxed)));
    voice_.setCeiling(unitRange(controls.ceiling.load(std::memory_order_relaxed)));

    readContact();
    const bool rateFits = rateHz == voice_.outputRateHz();
    decide(rateFits);
    if (!rateFits && voice_.isSilent()) {
        changeRate(rateHz);
    }
    noteBlock(out.size());
    takeSegments();
    const std::uint64_t uncoveredBefore = voice_.timeline().uncoveredSamples();
    const bool sounded = sounding_;
    // A panic ends with the block, however early in it the contact goes stale.
    const std::size_t fresh = panicking_ ? out.size() : framesUntilStale(out.size());
    sound(out.first(fresh));
    if (fresh < out.size()) {
        goStale();
        sound(out.subspan(fresh));
    }
    contactAgeFrames_ += out.size();
    count(channels_.counters.renderedFrames, out.size());
    channels_.audible.store(!voice_.isSilent(), std::memory_order_release);
    report(uncoveredBefore, sounded);
}

void VoiceRenderer::noteBlock(std::size_t frames) noexcept {
    // Devices may take turns between lengths; one that has gone over to shorter blocks is believed after a while.
    constexpr int remembered = 64;
    if (++blocksNoted_ >= remembered) {
        blocksNoted_ = 0;
        longestBlock_ = {0, longestBlock_[0]};
    }
    const double samples = static_cast<double>(frames) * inference::waveformRateHz / voice_.outputRateHz();
    longestBlock_[0] = std::max(longestBlock_[0], static_cast<std::int64_t>(std::ceil(samples)));
}

void VoiceRenderer::readContact() noexcept {
    if (channels_.toAudio.fetch()) {
        hasContact_ = true;
        contactAgeFrames_ = 0;
        stale_ = false;
        const AudioMessage& contact = channels_.toAudio.current();
        voice_.setRangeLaw(contact.levelGain, contact.readingRate);
    } else if (framesUntilStale(1) == 0) {
        goStale();
    }
    const std::uint32_t panics = channels_.controls.panics.load(std::memory_order_relaxed);
    if (panics != seenPanics_) {
        seenPanics_ = panics;
        panicking_ = true;
        hasSilencedTouch_ = true;
        silencedTouch_ = channels_.toAudio.current().touch;
    }
}

std::size_t VoiceRenderer::framesUntilStale(std::size_t frames) const noexcept {
    if (stale_ || !hasContact_) {
        return frames;
    }
    const auto limit = static_cast<std::uint64_t>(staleSeconds * voice_.outputRateHz());
    return static_cast<std::size_t>(std::min<std::uint64_t>(frames, limit - std::min(limit, contactAgeFrames_)));
}

void VoiceRenderer::goStale() noexcept {
    stale_ = true;
    if (sounding_) {
        sounding_ = false;
        tapFramesLeft_ = 0;
        voice_.release();
        count(channels_.counters.staleStops);
    }
}

void VoiceRenderer::decide(bool rateFits) noexcept {
    const AudioMessage& contact = channels_.toAudio.current();
    const VoiceControls& controls = channels_.controls;
    const bool silenced = hasSilencedTouch_ && contact.touch == silencedTouch_;
    const bool allowed = hasContact_ && !stale_ && !silenced && workerAlive_.load(std::memory_order_acquire) &&
                         !controls.muted.load(std::memory_order_relaxed) &&
                         !controls.paused.load(std::memory_order_relaxed) &&
                         !controls.closing.load(std::memory_order_relaxed);
    const bool isNew = contact.onset != playedOnset_;
    if (!allowed || !rateFits) {
        if (sounding_) {
            interruptedByRate_ = !rateFits;
            sounding_ = false;
            tapFramesLeft_ = 0;
            voice_.release();
        }
        interruptedByRate_ = interruptedByRate_ && allowed;
        // A touch that came and went unheard is over.
        if (!allowed && !contact.sliding) {
            playedOnset_ = contact.onset;
        }
        return;
    }
    if (isNew) {
        begin();
        if (!contact.sliding) {
            tapFramesLeft_ = static_cast<std::uint64_t>(tapSeconds * voice_.outputRateHz());
            count(channels_.counters.taps);
        }
    } else if (contact.sliding && !sounding_) {
        if (interruptedByRate_) {
            sounding_ = true;
            voice_.resume();
        } else {
            begin();
        }
    } else if (!contact.sliding && sounding_ && tapFramesLeft_ == 0) {
        sounding_ = false;
        voice_.release();
    }
    interruptedByRate_ = false;
}

void VoiceRenderer::begin() noexcept {
    const AudioMessage& contact = channels_.toAudio.current();
    ++stream_;
    playedOnset_ = contact.onset;
    tapFramesLeft_ = 0;
    sounding_ = true;
    voice_.setRangeLaw(contact.levelGain, contact.readingRate);
    voice_.onset(contact.seedMps2, 1.0F);
    count(channels_.counters.onsets);
}

void VoiceRenderer::takeSegments() noexcept {
    // Bounded: a worker that went wild could otherwise keep the callback here.
    for (std::size_t taken = 0; taken < SegmentQueue::capacity; ++taken) {
        const QueuedSegment* segment = channels_.segments.front();
        if (segment == nullptr) {
            return;
        }
        takenSequence_ = segment->sequence;
        headAtTake_[takenSequence_ % headAtTake_.size()] = voice_.timeline().head();
        const bool isMine = sounding_ && segment->stream == stream_;
        const std::int64_t takeOver = isMine ? voice_.commit(segment->start, segment->samplesMps2) : -1;
        if (takeOver < 0) {
            count(channels_.counters.dropped);
        } else if (takeOver > segment->start) {
            count(channels_.counters.late);
        }
        channels_.segments.pop();
    }
}

void VoiceRenderer::changeRate(double rateHz) noexcept {
    // One to delete at a time: until the worker has fetched it, the voice stays as it is. What is wanted gets it
    // called.
    if (channels_.usedOutput.load(std::memory_order_acquire) != nullptr) {
        channels_.wantedRateHz.store(rateHz, std::memory_order_release);
        return;
    }
    std::unique_ptr<OutputStage> fresh(channels_.freshOutput.exchange(nullptr, std::memory_order_acq_rel));
    if (fresh == nullptr) {
        channels_.wantedRateHz.store(rateHz, std::memory_order_release);
        return;
    }
    const bool fits = fresh->rateHz == rateHz;
    std::unique_ptr<OutputStage> used = fits ? voice_.exchangeOutput(std::move(fresh)) : std::move(fresh);
    channels_.wantedRateHz.store(fits ? 0.0 : rateHz, std::memory_order_release);
    channels_.usedOutput.store(used.release(), std::memory_order_release);
    if (fits) {
        count(channels_.counters.rateChanges);
        decide(true);
    }
}

void VoiceRenderer::sound(std::span<float> out) noexcept {
    if (panicking_) {
        panicking_ = false;
        sounding_ = false;
        tapFramesLeft_ = 0;
        voice_.renderStop(out);
        return;
    }
    if (tapFramesLeft_ > 0) {
        const std::size_t before = std::min<std::size_t>(out.size(), tapFramesLeft_);
        voice_.render(out.first(before));
        out = out.subspan(before);
        tapFramesLeft_ -= before;
        if (tapFramesLeft_ == 0 && !channels_.toAudio.current().sliding) {
            sounding_ = false;
            voice_.release();
        }
    }
    voice_.render(out);
}

void VoiceRenderer::report(std::uint64_t uncoveredBefore, bool sounded) noexcept {
    VoiceCounters& counters = channels_.counters;
    const WaveformTimeline& timeline = voice_.timeline();
    if (sounded && timeline.uncoveredSamples() > uncoveredBefore) {
        count(counters.underruns);
    }
    counters.nonFiniteSamples.store(voice_.limiter().nonFiniteCount(), std::memory_order_relaxed);
    counters.limitedSamples.store(voice_.limiter().limitedCount(), std::memory_order_relaxed);

    const bool running = sounding_;
    if (!running && !reportedRunning_) {
        return;
    }
    reportedRunning_ = running;
    Playhead& playhead = channels_.playhead.draft();
    playhead.stream = stream_;
    playhead.onset = playedOnset_;
    playhead.running = running;
    playhead.takenSequence = takenSequence_;
    playhead.headAtTake = headAtTake_;
    playhead.blockAdvance = std::max(longestBlock_[0], longestBlock_[1]);
    timeline.view(playhead.timeline);
    channels_.playhead.post();
}

}  // namespace haptoflow::engine
