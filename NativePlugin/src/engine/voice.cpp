#include "engine/voice.hpp"

#include <algorithm>

namespace haptoflow::engine {

Voice::Voice(double outputRateHz, float fullScaleMps2, EffectFigures& figures,
             std::shared_ptr<const skeleton::Skeleton> skeleton)
    : output_(std::make_unique<OutputStage>(outputRateHz)),
      skeleton_(std::move(skeleton)),
      level_(inference::waveformRateHz),
      limiter_(fullScaleMps2),
      figures_(figures) {}

std::unique_ptr<OutputStage> Voice::exchangeOutput(std::unique_ptr<OutputStage> output) noexcept {
    output->strength.reset(output_->strength.target());
    output->effects.adoptExposure(output_->effects);
    std::swap(output_, output);
    return output;
}

void Voice::begin(const skeleton::StreamParameters& parameters, double samplesAhead, const skeleton::NoiseKey& key,
                  skeleton::Segment beginningUnit) noexcept {
    const bool fromSilence = isTextureSilent();
    if (fromSilence) {
        waveform_.begin(parameters, samplesAhead, key);
    } else {
        waveform_.follow(parameters, samplesAhead);
    }
    if (skeleton_ == nullptr) {
        Correction beginning{.start = waveform_.head()};
        std::ranges::copy(beginningUnit, beginning.unit.begin());
        (void)waveform_.take(beginning);
    }
    if (fromSilence) {
        prime();
    }
    output_->gate.open();
}

std::int64_t Voice::take(const Correction& correction) noexcept {
    const std::int64_t start = waveform_.take(correction);
    if (start >= 0 && sink_ != nullptr) {
        sink_->tookOver(start);
    }
    return start;
}

void Voice::stop() noexcept {
    output_->gate.close();
    output_->effects.close();
}

void Voice::start(effects::EffectKind kind, double speedMps, const effects::ImpactResponse& response) noexcept {
    noteEvent(kind);
    output_->effects.start(kind, speedMps, response);
}

void Voice::followRelief(const effects::ReliefContact& contact) noexcept {
    if (contact.map != nullptr) {
        of(effects::EffectKind::relief).prepared.store(1, std::memory_order_relaxed);
    }
    output_->effects.followRelief(contact);
}

void Voice::startClip(std::span<const float> waveMps2, float gain, bool isLoop) noexcept {
    noteEvent(effects::EffectKind::clip);
    output_->effects.clip().start(waveMps2, gain, isLoop);
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
    // Before a stream there is silence. Read ahead by the resampler's delay, so that the first sample is the next to
    // sound.
    std::array<float, inference::segmentSamples> waveform{};
    highPass_.reset();
    readWaveform(std::span(waveform).last(output_->resampler.latencyInputSamples()));

    warp_.prime(std::span(waveform).last(dsp::RateWarp::historyLength));
    output_->resampler.prime(waveform);
    // Only now, because at a higher reading rate the filters would consume most of a tap before it sounds.
    warp_.setTargetRatio(readingRate_);
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
        waveform_.past(past);
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
    const std::int64_t start = waveform_.head();
    waveform_.read(skeleton_.get(), out);
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
}

}  // namespace haptoflow::engine
