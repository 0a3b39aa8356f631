#include "engine/segment_planner.hpp"

#include "inference/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>

namespace haptoflow::engine {
namespace {

// Waveform covered beyond the next update, so that the voice still sounds if that update is late.
constexpr double reserveSamples = 40.0;
// A tenth of a second of polling. The planner does not wait longer for a device that has stopped.
constexpr int maximumPolls = 50;
constexpr auto segmentLength = static_cast<std::int64_t>(inference::segmentSamples);

std::int64_t scaled(std::int64_t samples, double readingRate) noexcept {
    return static_cast<std::int64_t>(static_cast<double>(samples) * readingRate);
}

}  // namespace

SegmentPlanner::SegmentPlanner(VoiceChannels& channels, const PlannerSettings& settings) noexcept
    : channels_(channels),
      settings_(settings),
      track_(settings.seed, settings.voice),
      balance_(settings.seed, settings.voice) {}

bool SegmentPlanner::wake() noexcept {
    channels_.toWorker.fetch();
    if (channels_.playhead.fetch()) {
        learn();
    }
    const WorkerMessage& message = channels_.toWorker.current();
    const PublishedContact& contact = message.contact;
    const Playhead& playhead = channels_.playhead.current();
    if (!contact.sliding) {
        skipUntil(contact.slides);
        return false;
    }
    if (contact.slides == settledSlides_) {
        return false;
    }
    const bool isPlaying = playhead.running && playhead.onset == contact.onset;
    const bool isNewStream = playhead.stream != stream_;
    const std::int64_t head = playhead.timeline.head;
    const bool replaces = !isNewStream && head == lastHead_;
    // A full queue means that the callback takes no segments.
    if (!isPlaying || (replaces && !mayReplace()) || channels_.segments.room() < 2) {
        return false;
    }
    restorePast();
    const std::int64_t lead = leadSamples(playhead.blockAdvance, contact.ranged.readingRate);
    const std::int64_t start = std::min(head + lead, std::max(mirror_.coveredUntil(), head));
    if (!isNewStream && !replaces && start < lastStart_ + settings_.minimumHopSamples) {
        return false;
    }
    replacements_ = replaces ? replacements_ + 1 : 0;
    skipUntil(contact.slides - 1);
    settledSlides_ = contact.slides;
    polls_ = 0;
    if (!replaces) {
        hop_ = isNewStream ? 0 : head - lastHead_;
    }
    stream_ = playhead.stream;
    lastHead_ = head;
    lastStart_ = start;
    channels_.counters.leadSamples.store(static_cast<std::uint32_t>(lead), std::memory_order_relaxed);
    request_.embedding = message.material.embedding;
    request_.impulseGain = message.material.impulseGain;
    request_.motion = contact.ranged.motion;
    request_.levelMps2 = message.material.level.levelMps2;
    request_.levelMotion = message.material.level.motion;
    request_.levelGain = message.material.level.gain;
    restoreTrack(start);
    prepare(start);
    return true;
}

void SegmentPlanner::skipUntil(std::uint64_t slides) noexcept {
    if (slides > settledSlides_) {
        channels_.counters.skipped.fetch_add(slides - settledSlides_, std::memory_order_relaxed);
        settledSlides_ = slides;
    }
}

bool SegmentPlanner::mayReplace() const noexcept {
    // During a long block the clock stands still while new contact states arrive. Each may get a segment for the same
    // start, as often as the minimum hop fits into the block. The limit also ends the inference for a stopped clock.
    const Playhead& playhead = channels_.playhead.current();
    return settings_.minimumHopSamples > 0 && replacements_ + 1 < playhead.blockAdvance / settings_.minimumHopSamples;
}

bool SegmentPlanner::mustPoll() noexcept {
    if (!awaitsCallback() || polls_ >= maximumPolls) {
        return false;
    }
    ++polls_;
    return true;
}

bool SegmentPlanner::awaitsCallback() const noexcept {
    // Every reason for which `wake` did not generate ends when the callback runs: an onset that has not been played
    // yet, a clock that stands still, a hop that would be too short, a full queue.
    const PublishedContact& contact = channels_.toWorker.current().contact;
    return contact.sliding && contact.slides != settledSlides_;
}

void SegmentPlanner::learn() noexcept {
    const Playhead& playhead = channels_.playhead.current();
    for (Sent& sent : sent_) {
        const std::uint64_t sequence = sent.segment.sequence;
        if (sent.observed || sequence > playhead.takenSequence) {
            continue;
        }
        sent.observed = true;
        const bool isKnown = playhead.takenSequence - sequence < playhead.headAtTake.size();
        if (isKnown && sent.segment.stream == playhead.stream) {
            const std::int64_t headAtTake = playhead.headAtTake[sequence % playhead.headAtTake.size()];
            const auto advanced = static_cast<double>(headAtTake - sent.plannedHead);
            lead_.observe(static_cast<std::int64_t>(std::ceil(advanced / sent.readingRate)));
        }
    }
}

void SegmentPlanner::restorePast() noexcept {
    const Playhead& playhead = channels_.playhead.current();
    mirror_.restore(playhead.timeline);
    for (std::uint64_t sequence = playhead.takenSequence + 1; sequence <= sequence_; ++sequence) {
        const QueuedSegment& segment = sent_[sequence % sent_.size()].segment;
        if (segment.sequence == sequence && segment.stream == playhead.stream) {
            mirror_.commit(segment.start, segment.samplesMps2);
        }
    }
}

void SegmentPlanner::restoreTrack(std::int64_t start) noexcept {
    const Playhead& playhead = channels_.playhead.current();
    track_ = playhead.track;
    for (std::uint64_t sequence = playhead.takenSequence + 1; sequence <= sequence_; ++sequence) {
        const QueuedSegment& segment = sent_[sequence % sent_.size()].segment;
        // The segment at `start` replaces those that begin later.
        if (segment.sequence == sequence && segment.stream == playhead.stream && segment.start <= start) {
            track_ = segment.track;
        }
    }
}

std::int64_t SegmentPlanner::leadSamples(std::int64_t blockAdvance, double readingRate) const noexcept {
    return scaled(settings_.fixedLeadSamples.value_or(lead_.samples(blockAdvance)), readingRate);
}

void SegmentPlanner::prepare(std::int64_t start) noexcept {
    plannedStart_ = start;
    balance_.follow(channels_.toWorker.current().blend, request_.motion, start);
    mirror_.history(start, history_);
    const WorkerMessage& message = channels_.toWorker.current();
    const PublishedContact& contact = message.contact;
    const Playhead& playhead = channels_.playhead.current();
    const double sincePublished = channels_.isRealTime ? playhead.blockSeconds - contact.publishedSeconds : 0.0;
    request_.phases = track_.at(
        contact, message.material, start,
        secondsAhead(static_cast<double>(start) - playhead.blockPosition, contact.ranged.readingRate, sincePublished));
    fillNoise(track_.stretch().surface, track_.stretch().path,
              {.seed = settings_.seed, .voice = settings_.voice, .segment = segments_}, noise_);
    ++segments_;
}

bool SegmentPlanner::deliver(std::span<float, inference::segmentSamples> segmentMps2,
                             std::span<const float> sketchMps2) noexcept {
    const float balance = balance_.level(segmentMps2, request_.levelMps2.value_or(0.0F));
    channels_.counters.inferences.fetch_add(1, std::memory_order_relaxed);
    const PublishedContact& contact = channels_.toWorker.current().contact;
    const Playhead& playhead = channels_.playhead.current();
    ++sequence_;
    Sent& sent = sent_[sequence_ % sent_.size()];
    sent.segment.sequence = sequence_;
    sent.segment.stream = stream_;
    sent.segment.start = plannedStart_;
    sent.segment.update = contact.updates;
    sent.segment.levelMps2 = contact.levelMps2;
    sent.segment.balance = balance;
    track_.add(plannedStart_);
    sent.segment.track = track_;
    std::ranges::copy(segmentMps2, sent.segment.samplesMps2.begin());
    sent.segment.hasSketch = sketchMps2.size() == segmentMps2.size();
    if (sent.segment.hasSketch) {
        std::ranges::transform(sketchMps2, sent.segment.sketchMps2.begin(),
                               [balance](float sample) { return balance * sample; });
    }
    sent.plannedHead = playhead.timeline.head;
    sent.readingRate = contact.ranged.readingRate;
    sent.observed = false;
    if (!channels_.segments.push(sent.segment)) {
        --sequence_;
        return false;
    }
    mirror_.commit(plannedStart_, sent.segment.samplesMps2);
    const std::int64_t head = playhead.timeline.head;
    const auto lead = static_cast<double>(leadSamples(playhead.blockAdvance, contact.ranged.readingRate));
    const double needed = static_cast<double>(hop_) + lead + reserveSamples * contact.ranged.readingRate;
    const std::int64_t next = plannedStart_ + segmentLength;
    const std::int64_t furthest = static_cast<std::int64_t>(TimelineView::aheadSamples) - segmentLength;
    if (static_cast<double>(next - head) >= needed || next - head > furthest || channels_.segments.room() < 2) {
        return false;
    }
    prepare(next);
    return true;
}

void SegmentPlanner::fail() noexcept {
    channels_.counters.failures.fetch_add(1, std::memory_order_relaxed);
}

ProcessorSettings SegmentPlanner::requestedProcessors() const {
    const std::lock_guard lock(channels_.processorMutex);
    return channels_.processorSettings;
}

std::unique_ptr<Processors> SegmentPlanner::processorsFor(double rateHz) {
    const VoiceControls& controls = channels_.controls;
    const ProcessorSettings settings = requestedProcessors();
    keepsExposure_ = keepsExposure_ || settings.hasExposureGuard;
    return makeProcessors(settings, rateHz, controls.delaySeconds, controls.actuatorGain, keepsExposure_);
}

void SegmentPlanner::serveProcessors() noexcept {
    delete channels_.replacedProcessors.exchange(nullptr, std::memory_order_acq_rel);
    const double rateHz = channels_.stageRateHz.load(std::memory_order_acquire);
    const std::uint64_t wantedVersion = channels_.requestedProcessors.load(std::memory_order_acquire);
    const bool isServed = madeVersion_ == wantedVersion && madeRateHz_ == rateHz;
    if (rateHz == 0.0 || isServed || !channels_.lacksProcessors.load(std::memory_order_acquire)) {
        return;
    }
    try {
        std::unique_ptr<Processors> made = processorsFor(rateHz);
        if (made != nullptr) {
            madeVersion_ = made->version;
            madeRateHz_ = rateHz;
            delete channels_.freshProcessors.exchange(made.release(), std::memory_order_acq_rel);
        }
    } catch (const std::exception&) {
        // Out of memory: the voice keeps its present processors and requests the new ones again with its next state.
        return;
    }
}

void SegmentPlanner::serveOutputRate() noexcept {
    serveProcessors();
    delete channels_.replacedOutput.exchange(nullptr, std::memory_order_acq_rel);
    const double rateHz = channels_.requestedRateHz.exchange(0.0, std::memory_order_acq_rel);
    if (rateHz == 0.0) {
        return;
    }
    try {
        auto stage = std::make_unique<OutputStage>(rateHz);
        if (std::unique_ptr<Processors> made = processorsFor(rateHz)) {
            stage->effects.exchange(std::move(made));
            stage->effects.finishHandOver();
        }
        delete channels_.freshOutput.exchange(stage.release(), std::memory_order_acq_rel);
    } catch (const std::exception&) {
        // The rate is not supported, or out of memory; the callback requests a stage again.
        return;
    }
}

}  // namespace haptoflow::engine
