#include "engine/segment_planner.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {
namespace {

// Waveform covered beyond the next update, so that the voice still sounds if that update is late.
constexpr double reserveSamples = 40.0;
// Minimum number of samples between the starts of two segments: 5 ms. Corrections that replace each other sooner leave
// nothing of an impulse.
constexpr std::int64_t minimumHopSamples = 10;
// A tenth of a second of polling. The planner does not wait longer for a device that has stopped.
constexpr int maximumPolls = 50;
constexpr auto segmentLength = static_cast<std::int64_t>(inference::segmentSamples);

std::int64_t scaled(std::int64_t samples, double readingRate) noexcept {
    return static_cast<std::int64_t>(static_cast<double>(samples) * readingRate);
}

}  // namespace

SegmentPlanner::SegmentPlanner(VoiceChannels& channels, const PlannerSettings& settings,
                               std::shared_ptr<const skeleton::Skeleton> skeleton) noexcept
    : channels_(channels), settings_(settings), skeleton_(std::move(skeleton)) {}

bool SegmentPlanner::wake() noexcept {
    channels_.toWorker.fetch();
    if (channels_.playhead.fetch()) {
        learn();
    }
    const PublishedContact& contact = channels_.toWorker.current().contact;
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
    const std::int64_t head = playhead.waveform.head();
    const bool replaces = !isNewStream && head == lastHead_;
    // A full queue means that the callback takes no segments.
    if (!isPlaying || (replaces && !mayReplace()) || channels_.corrections.room() < 2) {
        return false;
    }
    copyWaveform();
    const std::int64_t lead = leadSamples(playhead.blockAdvance, contact.ranged.readingRate);
    // Without a skeleton, a segment that takes over behind the last one would leave a gap.
    const std::int64_t start =
        skeleton_ != nullptr ? head + lead : std::min(head + lead, std::max(ahead_.correctedUntil(), head));
    if (!isNewStream && !replaces && start < lastStart_ + minimumHopSamples) {
        return false;
    }
    replacements_ = replaces ? replacements_ + 1 : 0;
    skipUntil(contact.slides - 1);
    settledSlides_ = contact.slides;
    polls_ = 0;
    if (!replaces) {
        hop_ = isNewStream ? 0 : head - lastHead_;
    }
    if (isNewStream) {
        beginPast();
    }
    stream_ = playhead.stream;
    lastHead_ = head;
    lastStart_ = start;
    channels_.counters.leadSamples.store(static_cast<std::uint32_t>(lead), std::memory_order_relaxed);
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
    return replacements_ + 1 < playhead.blockAdvance / minimumHopSamples;
}

bool SegmentPlanner::mustPoll() noexcept {
    // Every reason for which `wake` did not generate ends when the callback runs: an onset that has not been played
    // yet, a clock that stands still, a hop that would be too short, a full queue.
    const PublishedContact& contact = channels_.toWorker.current().contact;
    if (!contact.sliding || contact.slides == settledSlides_ || polls_ >= maximumPolls) {
        return false;
    }
    ++polls_;
    return true;
}

void SegmentPlanner::learn() noexcept {
    const Playhead& playhead = channels_.playhead.current();
    for (Sent& sent : sent_) {
        const std::uint64_t sequence = sent.correction.sequence;
        if (sent.observed || sequence > playhead.takenSequence) {
            continue;
        }
        sent.observed = true;
        const bool isKnown = playhead.takenSequence - sequence < playhead.headAtTake.size();
        if (isKnown && sent.correction.stream == playhead.stream) {
            const std::int64_t headAtTake = playhead.headAtTake[sequence % playhead.headAtTake.size()];
            const auto advanced = static_cast<double>(headAtTake - sent.plannedHead);
            lead_.observe(static_cast<std::int64_t>(std::ceil(advanced / sent.readingRate)));
        }
    }
}

void SegmentPlanner::copyWaveform() noexcept {
    const ContactMessage& message = channels_.toWorker.current();
    const Playhead& playhead = channels_.playhead.current();
    ahead_ = playhead.waveform;
    if (message.contact.updates > playhead.update) {
        ahead_.follow(message.stream, channels_.samplesAhead(message.contact, ahead_.head(), playhead.blockPosition,
                                                             playhead.blockSeconds));
    }
    for (std::uint64_t sequence = playhead.takenSequence + 1; sequence <= sequence_; ++sequence) {
        const Correction& correction = sent_[sequence % sent_.size()].correction;
        if (correction.sequence == sequence && correction.stream == playhead.stream) {
            (void)ahead_.take(correction);
        }
    }
}

void SegmentPlanner::beginPast() noexcept {
    const ContactMessage& message = channels_.toWorker.current();
    if (skeleton_ == nullptr) {
        firstPast_ = message.material.pastMps2;
        return;
    }
    // A stream begins in the midst of a stroke: what would have led there has never sounded.
    constexpr auto samples = static_cast<double>(inference::segmentSamples);
    const skeleton::NoiseKey key{
        .seed = settings_.seed, .voice = settings_.voice, .segment = (std::uint64_t{1} << 62U) + stream_};
    skeleton::Stream before;
    before.begin(message.stream, -samples, key);
    before.next(skeleton_.get(), firstPast_);
    std::ranges::for_each(firstPast_, [&before](float& sample) { sample *= before.levelMps2(); });
}

std::int64_t SegmentPlanner::leadSamples(std::int64_t blockAdvance, double readingRate) const noexcept {
    return scaled(settings_.fixedLeadSamples.value_or(lead_.samples(blockAdvance)), readingRate);
}

void SegmentPlanner::prepare(std::int64_t start) noexcept {
    ahead_.expect(start);
    std::array<float, inference::segmentSamples> read{};
    while (ahead_.head() < start) {
        const auto samples = std::min(start - ahead_.head(), segmentLength);
        ahead_.read(skeleton_.get(), std::span(read).first(static_cast<std::size_t>(samples)));
    }
    const ContactMessage& message = channels_.toWorker.current();
    ahead_.past(history_);
    ahead_.ownPast(ownHistory_);
    const auto played = std::clamp<std::int64_t>(ahead_.head() - ahead_.beginning(), 0, segmentLength);
    std::copy(firstPast_.begin() + played, firstPast_.end(), history_.begin());
    if (skeleton_ != nullptr) {
        std::copy(firstPast_.begin() + played, firstPast_.end(), ownHistory_.begin());
    }
    request_.embedding = message.material.embedding;
    request_.impulseGain = message.material.impulseGain;
    request_.motion = message.contact.ranged.motion;
    request_.phases = ahead_.stream().phases();
    request_.levelMotion = message.material.level.motion;
    request_.levelGain = message.material.level.gain;
    request_.levelMps2 =
        skeleton_ != nullptr ? std::optional(message.stream.levelMps2) : message.material.level.levelMps2;

    skeleton::Stream stream = ahead_.stream();
    std::array<float, inference::segmentSamples> unit{};
    stream.next(skeleton_.get(), unit, &input_);
}

bool SegmentPlanner::deliver(std::span<const float, inference::segmentSamples> segmentMps2) noexcept {
    channels_.counters.inferences.fetch_add(1, std::memory_order_relaxed);
    const ContactMessage& message = channels_.toWorker.current();
    const Playhead& playhead = channels_.playhead.current();
    const double readingRate = message.contact.ranged.readingRate;
    ++sequence_;
    Sent& sent = sent_[sequence_ % sent_.size()];
    sent.correction.sequence = sequence_;
    sent.correction.stream = stream_;
    sent.correction.start = ahead_.head();
    const float levelMps2 = message.stream.levelMps2;
    std::ranges::transform(
        segmentMps2, input_.segment(), sent.correction.unit.begin(),
        [levelMps2](float sample, float streamed) { return skeleton::finiteOrZero(sample / levelMps2 - streamed); });
    const std::int64_t head = playhead.waveform.head();
    sent.plannedHead = head;
    sent.readingRate = readingRate;
    sent.observed = false;
    if (!channels_.corrections.push(sent.correction)) {
        --sequence_;
        return false;
    }
    (void)ahead_.take(sent.correction);
    const auto lead = static_cast<double>(leadSamples(playhead.blockAdvance, readingRate));
    const double needed = static_cast<double>(hop_) + lead + reserveSamples * readingRate;
    const std::int64_t next = ahead_.head() + segmentLength;
    const bool isEnough = static_cast<double>(next - head) >= needed;
    if (isEnough || next + segmentLength - head > Waveform::aheadSamples || channels_.corrections.room() < 2) {
        return false;
    }
    prepare(next);
    return true;
}

void SegmentPlanner::fail() noexcept {
    channels_.counters.failures.fetch_add(1, std::memory_order_relaxed);
}

std::unique_ptr<Processors> SegmentPlanner::processorsFor(double rateHz) {
    const VoiceControls& controls = channels_.controls;
    const ProcessorSettings settings = [this] {
        const std::lock_guard lock(channels_.processorMutex);
        return channels_.processorSettings;
    }();
    keepsExposure_ = keepsExposure_ || settings.hasExposureGuard;
    return makeProcessors(settings, rateHz, controls.delaySeconds, controls.actuatorGain, keepsExposure_);
}

void SegmentPlanner::serveProcessors() noexcept {
    channels_.processors.collect();
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
            channels_.processors.offer(std::move(made));
        }
    } catch (const std::exception&) {
        // Out of memory: the voice keeps its present processors and requests the new ones again with its next state.
        return;
    }
}

void SegmentPlanner::serveOutputRate() noexcept {
    serveProcessors();
    channels_.outputs.collect();
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
        channels_.outputs.offer(std::move(stage));
    } catch (const std::exception&) {
        // The rate is not supported, or out of memory; the callback requests a stage again.
        return;
    }
}

}  // namespace haptoflow::engine
