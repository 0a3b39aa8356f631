#include "engine/effect_stage.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <functional>
#include <utility>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;

// An edge is over before the next one can come: ribs and rims follow each other faster than landings.
constexpr double edgeDecayFactor = 3.0;
constexpr double handOverSeconds = 0.01;

void run(effects::Effect& effect, EffectKind kind, std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    const auto began = std::chrono::steady_clock::now();
    effect.process(samplesMps2);
    const auto spent = std::chrono::steady_clock::now() - began;
    EffectFigures::OfKind& own = figures.of(kind);
    ++own.runs;
    own.samples += samplesMps2.size();
    own.nanoseconds += static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count());
}

template <typename Visit>
void forEach(const Processors* processors, const Visit& visit) {
    if (processors == nullptr) {
        return;
    }
    const std::array<std::pair<effects::Effect*, EffectKind>, 2> stages{{
        {processors->delay.get(), EffectKind::delay},
        {processors->compensation.get(), EffectKind::compensation},
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
    : impact_(EffectKind::impact, outputRateHz),
      edge_(EffectKind::edge, outputRateHz, edgeDecayFactor),
      gate_(outputRateHz),
      fadeSamples_(std::max<std::size_t>(1, static_cast<std::size_t>(handOverSeconds * outputRateHz))) {}

void EffectStage::strikeImpact(double speedMps, const effects::ImpactResponse& response) noexcept {
    impact_.strike(speedMps, response);
}

void EffectStage::strikeEdge(double speedMps, const effects::ImpactResponse& response) noexcept {
    edge_.strike(speedMps, response);
}

void EffectStage::exchange(std::unique_ptr<Processors> fresh) noexcept {
    if (fresh->exposureGuard == nullptr || guard_ == nullptr) {
        std::swap(guard_, fresh->exposureGuard);
    }
    leaving_ = std::exchange(processors_, std::move(fresh));
    fadeLeft_ = fadeSamples_;
}

std::unique_ptr<Processors> EffectStage::takeUsed() noexcept {
    return fadeLeft_ == 0 ? std::move(leaving_) : nullptr;
}

void EffectStage::open() noexcept {
    if (gate_.isClosed()) {
        // Blows begin at zero by themselves, and a ramp would take their attack.
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
    return impact_.isIdle() && edge_.isIdle() && allIdle(processors_.get()) &&
           (fadeLeft_ == 0 || allIdle(leaving_.get()));
}

void EffectStage::adoptExposure(const EffectStage& before) noexcept {
    if (guard_ != nullptr && before.guard_ != nullptr) {
        guard_->continueFrom(*before.guard_);
    }
}

void EffectStage::setDelaySeconds(double seconds) noexcept {
    if (processors_ != nullptr && processors_->delay != nullptr) {
        processors_->delay->setDelaySeconds(seconds);
    }
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
    if (guard_ != nullptr) {
        guard_->reset();
    }
    resetAll(processors_.get());
    resetAll(leaving_.get());
    fadeLeft_ = 0;
    gate_.reset();
}

void EffectStage::process(std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    runSources(samplesMps2, figures);
    if (hasProcessors()) {
        runProcessors(samplesMps2, figures);
        if (guard_ != nullptr) {
            run(*guard_, EffectKind::exposureGuard, samplesMps2, figures);
        }
        passGate(samplesMps2);
    }
}

void EffectStage::runSources(std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    // Without processors the texture has its own gate already: only blows are silenced here.
    if (impact_.isIdle() && edge_.isIdle()) {
        return;
    }
    std::array<float, blockSamples> blows{};
    const std::span<float> target = hasProcessors() ? samplesMps2 : std::span(blows).first(samplesMps2.size());
    if (!impact_.isIdle()) {
        run(impact_, EffectKind::impact, target, figures);
    }
    if (!edge_.isIdle()) {
        run(edge_, EffectKind::edge, target, figures);
    }
    if (!hasProcessors()) {
        passGate(target);
        std::ranges::transform(target, samplesMps2, samplesMps2.begin(), std::plus<>());
    }
}

bool EffectStage::hasProcessors() const noexcept {
    bool has = fadeLeft_ > 0 || guard_ != nullptr;
    forEach(processors_.get(), [&has](const effects::Effect&, EffectKind) { has = true; });
    return has;
}

void EffectStage::runProcessors(std::span<float> samplesMps2, EffectFigures& figures) noexcept {
    if (fadeLeft_ == 0) {
        runAll(processors_.get(), samplesMps2, figures);
        return;
    }
    std::array<float, blockSamples> before{};
    const std::span<float> old = std::span(before).first(samplesMps2.size());
    std::ranges::copy(samplesMps2, old.begin());
    runAll(leaving_.get(), old, figures);
    runAll(processors_.get(), samplesMps2, figures);
    for (std::size_t i = 0; i < samplesMps2.size(); ++i) {
        const float share = static_cast<float>(fadeLeft_) / static_cast<float>(fadeSamples_);
        samplesMps2[i] += share * (old[i] - samplesMps2[i]);
        fadeLeft_ -= fadeLeft_ > 0 ? 1 : 0;
    }
}

void EffectStage::passGate(std::span<float> samplesMps2) noexcept {
    gate_.process(samplesMps2);
    if (gate_.isClosed()) {
        reset();
    }
}

}  // namespace haptoflow::engine
