#include "engine/effect_stage.hpp"

#include "effects/compensation.hpp"
#include "effects/device_loudness.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace haptoflow::engine {

std::unique_ptr<Processors> makeProcessors(const ProcessorSettings& settings, double rateHz, double delaySeconds,
                                           double actuatorGain, bool keepsExposure) {
    if (settings.version == 0) {
        return nullptr;
    }
    auto made = std::make_unique<Processors>();
    made->version = settings.version;
    made->rateHz = rateHz;
    if (settings.hasDelay) {
        made->delay = std::make_unique<effects::Delay>(rateHz);
        made->delay->setDelaySeconds(delaySeconds);
    }
    if (settings.actuator != nullptr) {
        made->compensation = std::make_unique<effects::Compensation>(*settings.actuator, rateHz);
    }
    if (settings.listenFullScaleMps2 > 0.0) {
        made->listen = std::make_unique<effects::Listen>(rateHz, settings.listenFullScaleMps2);
    }
    if (settings.hasExposureGuard || keepsExposure) {
        made->exposureGuard = std::make_unique<effects::ExposureGuard>(rateHz);
        made->exposureGuard->switchOn(settings.hasExposureGuard);
        made->exposureGuard->setActuatorGain(actuatorGain);
    }
    return made;
}

namespace {

using effects::EffectKind;

// Edges decay faster than landings, because ribs and rims follow each other faster.
constexpr double edgeDecayFactor = 3.0;
constexpr double handOverSeconds = 0.01;

void run(effects::Effect& effect, EffectKind kind, std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    figures[static_cast<std::size_t>(kind)].countRun(samplesMps2.size(), [&] { effect.process(samplesMps2); });
}

template <typename Visit>
void forEach(const Processors* processors, const Visit& visit) {
    if (processors == nullptr) {
        return;
    }
    const std::array<std::pair<effects::Effect*, EffectKind>, 3> stages{{
        {processors->delay.get(), EffectKind::delay},
        {processors->compensation.get(), EffectKind::compensation},
        {processors->listen.get(), EffectKind::listen},
    }};
    for (const auto& [effect, kind] : stages) {
        if (effect != nullptr) {
            visit(*effect, kind);
        }
    }
}

void runAll(const Processors* processors, std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    forEach(processors, [&](effects::Effect& effect, EffectKind kind) { run(effect, kind, samplesMps2, figures); });
}

bool allIdle(const Processors* processors) noexcept {
    bool idle = true;
    forEach(processors, [&idle](const effects::Effect& effect, EffectKind) { idle = idle && effect.isIdle(); });
    return idle;
}

void resetAll(const Processors* processors) noexcept {
    forEach(processors, [](effects::Effect& effect, EffectKind) { effect.reset(); });
}

}  // namespace

EffectStage::EffectStage(double outputRateHz)
    : impact_(outputRateHz),
      edge_(outputRateHz, edgeDecayFactor),
      relief_(outputRateHz),
      clip_(outputRateHz),
      signal_(outputRateHz),
      gate_(outputRateHz),
      fadeSamples_(std::max<std::size_t>(1, static_cast<std::size_t>(handOverSeconds * outputRateHz))) {}

void EffectStage::exchange(std::unique_ptr<Processors> fresh) noexcept {
    settleDelay();
    if (guard_ == nullptr) {
        std::swap(guard_, fresh->exposureGuard);
    } else {
        guard_->switchOn(fresh->exposureGuard != nullptr && fresh->exposureGuard->isOn());
    }
    replaced_ = std::exchange(processors_, std::move(fresh));
    if (delay_ != nullptr && processors_->delay != nullptr) {
        processors_->spareDelay = std::move(processors_->delay);
    } else if (delay_ != nullptr) {
        replaced_->delay = std::move(delay_);
    }
    fadeRemaining_ = fadeSamples_;
}

void EffectStage::finishHandOver() noexcept {
    if (fadeRemaining_ > 0 && processors_->listen != nullptr) {
        processors_->listen->reset();
    }
    fadeRemaining_ = 0;
}

void EffectStage::settleDelay() noexcept {
    if (fadeRemaining_ == 0 && delay_ == nullptr && processors_ != nullptr) {
        delay_ = std::move(processors_->delay);
    }
}

std::unique_ptr<Processors> EffectStage::takeReplaced() noexcept {
    return fadeRemaining_ == 0 ? std::move(replaced_) : nullptr;
}

void EffectStage::open() noexcept {
    if (gate_.isClosed()) {
        // ContactEvents start at zero by themselves, and a ramp would remove their attack.
        gate_.openAtOnce();
    } else {
        gate_.open();
    }
}

void EffectStage::close() noexcept {
    gate_.close();
    if (isIdle()) {
        reset();
    }
}

bool EffectStage::isIdle() const noexcept {
    return (delay_ == nullptr || delay_->isIdle()) && areSourcesIdle() && allIdle(processors_.get()) &&
           (fadeRemaining_ == 0 || allIdle(replaced_.get()));
}

void EffectStage::adoptExposure(const EffectStage& before) noexcept {
    if (guard_ != nullptr && before.guard_ != nullptr) {
        guard_->continueFrom(*before.guard_);
    }
}

void EffectStage::setDelaySeconds(double seconds) noexcept {
    if (delay_ != nullptr) {
        delay_->setDelaySeconds(seconds);
    }
    if (processors_ != nullptr && processors_->delay != nullptr) {
        processors_->delay->setDelaySeconds(seconds);
    }
}

double EffectStage::delaySeconds() const noexcept {
    if (delay_ != nullptr) {
        return delay_->delaySeconds();
    }
    return processors_ != nullptr && processors_->delay != nullptr ? processors_->delay->delaySeconds() : 0.0;
}

void EffectStage::setActuatorGain(double gain) noexcept {
    if (guard_ != nullptr) {
        guard_->setActuatorGain(gain);
    }
}

void EffectStage::passSilence(std::size_t samples) noexcept {
    if (guard_ != nullptr) {
        guard_->passSilence(samples);
    }
}

std::uint64_t EffectStage::version() const noexcept {
    return processors_ == nullptr ? 0 : processors_->version;
}

void EffectStage::reset() noexcept {
    impact_.reset();
    edge_.reset();
    relief_.reset();
    clip_.reset();
    signal_.reset();
    if (guard_ != nullptr) {
        guard_->reset();
    }
    if (delay_ != nullptr) {
        delay_->reset();
    }
    resetAll(processors_.get());
    resetAll(replaced_.get());
    fadeRemaining_ = 0;
    gate_.reset();
}

void EffectStage::process(std::span<float> samplesMps2, dsp::LevelSmoother& strength, EffectFigures& figures) noexcept {
    if (!hasProcessors()) {
        strength.process(samplesMps2);
        return;
    }
    settleDelay();
    if (delay_ != nullptr) {
        run(*delay_, EffectKind::delay, samplesMps2, figures);
    }
    runProcessors(samplesMps2, figures);
    strength.process(samplesMps2);
    if (guard_ != nullptr) {
        run(*guard_, EffectKind::exposureGuard, samplesMps2, figures);
    }
    passGate(samplesMps2);
}

bool EffectStage::areSourcesIdle() const noexcept {
    return impact_.isIdle() && edge_.isIdle() && relief_.isIdle() && clip_.isIdle() && signal_.isIdle();
}

void EffectStage::addSources(std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    // The texture has its own gate. Without processors, this gate applies only to the sources added here.
    if (areSourcesIdle()) {
        return;
    }
    std::array<float, blockSamples> added{};
    const std::span<float> target = hasProcessors() ? samplesMps2 : std::span(added).first(samplesMps2.size());
    using Source = std::pair<effects::Effect&, EffectKind>;
    for (const auto& [source, kind] :
         {Source(impact_, EffectKind::impact), Source(edge_, EffectKind::edge), Source(relief_, EffectKind::relief),
          Source(clip_, EffectKind::clip), Source(signal_, EffectKind::signal)}) {
        if (!source.isIdle()) {
            run(source, kind, target, figures);
        }
    }
    if (!hasProcessors()) {
        passGate(target);
        std::ranges::transform(target, samplesMps2, samplesMps2.begin(), std::plus<>());
    }
}

bool EffectStage::hasProcessors() const noexcept {
    bool has = fadeRemaining_ > 0 || guard_ != nullptr || delay_ != nullptr;
    forEach(processors_.get(), [&has](const effects::Effect&, EffectKind) { has = true; });
    return has;
}

void EffectStage::runProcessors(std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    if (fadeRemaining_ == 0) {
        runAll(processors_.get(), samplesMps2, figures);
        return;
    }
    std::array<float, blockSamples> before{};
    const std::span<float> old = std::span(before).first(samplesMps2.size());
    std::ranges::copy(samplesMps2, old.begin());
    runAll(replaced_.get(), old, figures);
    const auto shareAt = [this](std::size_t sample) {
        return static_cast<float>(fadeRemaining_ - std::min(fadeRemaining_, sample)) / static_cast<float>(fadeSamples_);
    };
    if (processors_->delay != nullptr || processors_->listen != nullptr) {
        // Fade the input in: a new delay would otherwise play an abrupt start after its delay time, and a new Listen
        // would brighten it to a click.
        for (std::size_t i = 0; i < samplesMps2.size(); ++i) {
            samplesMps2[i] *= 1.0F - shareAt(i);
        }
    }
    runAll(processors_.get(), samplesMps2, figures);
    for (std::size_t i = 0; i < samplesMps2.size(); ++i) {
        samplesMps2[i] += shareAt(i) * (old[i] - samplesMps2[i]);
    }
    fadeRemaining_ -= std::min(fadeRemaining_, samplesMps2.size());
}

void EffectStage::passGate(std::span<float> samplesMps2) noexcept {
    gate_.process(samplesMps2);
    if (gate_.isClosed()) {
        reset();
    }
}

}  // namespace haptoflow::engine
