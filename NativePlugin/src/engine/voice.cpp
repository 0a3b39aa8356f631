#include "engine/voice.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {

Voice::Voice(double outputRateHz, float fullScaleMps2, EffectFigures& figures, std::unique_ptr<Sketcher> sketcher)
    : output_(std::make_unique<OutputStage>(outputRateHz)),
      level_(inference::waveformRateHz),
      limiter_(fullScaleMps2),
      sketcher_(std::move(sketcher)),
      figures_(figures) {}

std::unique_ptr<OutputStage> Voice::exchangeOutput(std::unique_ptr<OutputStage> output) noexcept {
    output->strength.reset(output_->strength.target());
    output->effects.adoptExposure(output_->effects);
    std::swap(output_, output);
    return output;
}

void Voice::onset(std::span<const float, WaveformTimeline::seedSamples> seedMps2, float levelMps2) noexcept {
    const bool fromSilence = isTextureSilent();
    if (fromSilence) {
        timeline_.clear();
    }
    timeline_.open(seedMps2);
    follower_.begin(timeline_.head(), levelMps2);
    if (fromSilence) {
        prime();
    }
    output_->gate.open();
}

void Voice::beginSketch(float levelMps2) noexcept {
    std::array<float, WaveformTimeline::seedSamples> seedMps2{};
    sketcher_->begin(timeline_.head(), seedMps2);
    onset(seedMps2, levelMps2);
}

void Voice::renewSketch(float levelMps2) noexcept {
    sketcher_->renew(timeline_);
    // The sketch has this level already.
    follower_.begin(timeline_.head(), levelMps2);
}

std::int64_t Voice::take(const QueuedSegment& segment) noexcept {
    if (sketcher_ == nullptr) {
        return commit(segment.start, segment.samplesMps2, segment.levelMps2);
    }
    const Sketcher::Taken taken = sketcher_->take(timeline_, segment);
    if (taken.use == Sketcher::Use::whole) {
        noteTakeOver(taken.start, segment.levelMps2);
    }
    return taken.use == Sketcher::Use::dropped ? -1 : taken.start;
}

void Voice::noteTakeOver(std::int64_t sample, float levelMps2) noexcept {
    follower_.takeOver(sample, levelMps2);
    if (sink_ != nullptr) {
        sink_->tookOver(sample);
    }
}

void Voice::stop() noexcept {
    output_->gate.close();
    output_->effects.close();
}

void Voice::start(effects::EffectKind kind, double speedMps, const effects::ImpactResponse& response) noexcept {
    noteEvent(kind);
    output_->effects.start(kind, speedMps, response);
}

void Voice::beginSignal() noexcept {
    noteEvent(effects::EffectKind::signal);
    output_->effects.beginSignal();
}

void Voice::noteEvent(effects::EffectKind kind) noexcept {
    of(kind).prepared.store(1, std::memory_order_relaxed);
    increase(of(kind).events);
}

void Voice::exchangeProcessors(std::unique_ptr<Processors> fresh) noexcept {
    const auto note = [this](const effects::Effect* effect, effects::EffectKind kind) {
        increase(of(kind).prepared, effect == nullptr ? 0 : 1);
    };
    note(fresh->delay.get(), effects::EffectKind::delay);
    note(fresh->compensation.get(), effects::EffectKind::compensation);
    if (fresh->exposureGuard != nullptr && fresh->exposureGuard->isOn()) {
        note(fresh->exposureGuard.get(), effects::EffectKind::exposureGuard);
    }
    note(fresh->listen.get(), effects::EffectKind::listen);
    output_->effects.exchange(std::move(fresh));
}

void Voice::setStrength(float strength) noexcept {
    if (isSilent()) {
        output_->strength.reset(strength);
    } else {
        output_->strength.setTarget(strength);
    }
}

void Voice::prime() noexcept {
    level_.reset(level_.target());
    std::array<float, inference::segmentSamples> waveform{};
    timeline_.history(timeline_.head(), waveform);
    applyTone(waveform);
    highPass_.reset();
    highPass_.process(waveform);
    level_.process(waveform);
    // Read ahead by the resampler's delay, so that the seed's first sample is the next to sound.
    const std::size_t ahead = output_->resampler.latencyInputSamples();
    std::ranges::copy(std::span(waveform).subspan(ahead), waveform.begin());
    readWaveform(std::span(waveform).last(ahead));

    warp_.prime(std::span(waveform).last(dsp::RateWarp::historyLength));
    output_->resampler.prime(waveform);
    // Only now, because at a higher reading rate the filters would consume most of a seed before it sounds.
    warp_.setTargetRatio(readingRate_);
}

std::int64_t Voice::commit(std::int64_t start, std::span<const float, inference::segmentSamples> segment,
                           float levelMps2) noexcept {
    const std::int64_t takeOver = timeline_.commit(start, segment);
    if (takeOver >= 0) {
        noteTakeOver(takeOver, levelMps2);
    }
    return takeOver;
}

void Voice::setRangeLaw(double levelGain, double readingRate) noexcept {
    readingRate_ = readingRate;
    if (isTextureSilent()) {
        level_.reset(static_cast<float>(levelGain));
    } else {
        level_.setTarget(static_cast<float>(levelGain));
    }
    warp_.setTargetRatio(readingRate);
}

void Voice::setTone(const dsp::ToneKernel* kernel) noexcept {
    const bool isRunning = tone_.isActive();
    if (isTextureSilent()) {
        tone_.reset(kernel);
    } else if (!tone_.isTarget(kernel)) {
        std::array<float, inference::segmentSamples> past{};
        timeline_.history(timeline_.head(), past);
        tone_.setTone(kernel, std::span(past).last<dsp::ToneFilter::memorySamples>());
    }
    if (tone_.isActive() && !isRunning) {
        increase(of(effects::EffectKind::tone).prepared);
    }
}

void Voice::applyTone(std::span<float> samplesMps2) noexcept {
    if (!tone_.isActive() || samplesMps2.empty()) {
        return;
    }
    of(effects::EffectKind::tone).countRun(samplesMps2.size(), [&] { tone_.process(samplesMps2); });
}

void Voice::readWaveform(std::span<float> out) noexcept {
    if (sketcher_ != nullptr) {
        sketcher_->extend(timeline_, out.size());
    }
    const std::int64_t start = timeline_.head();
    timeline_.read(out);
    follower_.process(start, out);
    applyTone(out);
    if (sink_ != nullptr && !out.empty()) {
        sink_->played(start, out);
    }
    highPass_.process(out);
    level_.process(out);
}

void Voice::produce(std::span<float> out) noexcept {
    // At the minimum output rate a block needs 17 samples at 2 kHz, and the warp consumes at most 4 for each plus 41.
    std::array<float, 32> steady{};
    std::array<float, 160> waveform{};
    const std::size_t steadyCount = std::min(output_->resampler.inputNeeded(out.size()), steady.size());
    const auto steadySpan = std::span(steady).first(steadyCount);
    const std::size_t waveformCount = std::min(warp_.inputNeeded(steadyCount), waveform.size());
    const auto waveformSpan = std::span(waveform).first(waveformCount);
    readWaveform(waveformSpan);
    warp_.process(waveformSpan, steadySpan);
    output_->resampler.process(steadySpan, out);
}

void Voice::render(std::span<float> out) noexcept {
    while (!out.empty()) {
        const auto block = out.first(std::min(out.size(), blockSamples));
        out = out.subspan(block.size());
        if (isSilent()) {
            std::ranges::fill(block, 0.0F);
            output_->effects.passSilence(block.size());
            continue;
        }
        if (isTextureSilent()) {
            std::ranges::fill(block, 0.0F);
        } else {
            produce(block);
            output_->gate.process(block);
        }
        output_->effects.addSources(block, figures_);
        output_->effects.process(block, output_->strength, figures_);
        limiter_.scale(block);
        if (limit_ == Limit::voice) {
            limiter_.processScaled(block);
        }
    }
}

void Voice::limitSum(std::span<float> sum, float ceiling) noexcept {
    limiter_.setCeiling(ceiling);
    limiter_.processScaled(sum);
}

void Voice::renderStop(std::span<float> out) noexcept {
    const std::size_t count = out.size();
    render(out);
    for (std::size_t i = 0; i < count; ++i) {
        out[i] *= static_cast<float>(count - 1 - i) / static_cast<float>(count);
    }
    output_->gate.reset();
    output_->effects.reset();
    timeline_.clear();
}

}  // namespace haptoflow::engine
