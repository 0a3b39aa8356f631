#include "engine/contact_publisher.hpp"

#include "engine/material.hpp"
#include "engine/range_law.hpp"
#include "engine/surface_phases.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace haptoflow::engine {

ContactAction ContactFollower::update(const ContactState& state, double nowSeconds) noexcept {
    const bool isTouching = state.touching != 0;
    // The counter starts at 0, so a first state with a counter above 0 reports a touch that began before that state.
    const bool newTouch = state.touchCounter != touchCounter_;
    const bool isNewContact = newTouch || (isTouching && !touching_);
    touches_ += isNewContact ? 1 : 0;
    touchCounter_ = state.touchCounter;
    touching_ = isTouching;
    const bool wasSliding = sliding_;
    const bool hasTexture = state.hasEffect(effects::EffectKind::texture);
    sliding_ = isTouching &&
               (state.hasPlace != 0 ? slidesByDistance(state, isNewContact, nowSeconds)
                                    : slidesBySpeed(state.speedMps(), newTouch)) &&
               hasTexture;
    if (sliding_) {
        return wasSliding && !newTouch ? ContactAction::slide : ContactAction::onset;
    }
    if (newTouch && hasTexture && !isTouching && state.speedMps() >= slideStartMps) {
        return ContactAction::tap;
    }
    return wasSliding ? ContactAction::release : ContactAction::rest;
}

bool ContactFollower::slidesBySpeed(float speedMps, bool isNewTouch) const noexcept {
    return speedMps >= (sliding_ && !isNewTouch ? slideEndMps : slideStartMps);
}

bool ContactFollower::slidesByDistance(const ContactState& state, bool isNewContact, double nowSeconds) noexcept {
    const float speed = state.speedMps();
    if (isNewContact || !pointMetres_ || surfaceSeed_ != state.surfaceSeed) {
        surfaceSeed_ = state.surfaceSeed;
        pointMetres_ = state.placeMetres;
        pulledSeconds_ = nowSeconds;
        return isNewContact ? speed >= strokeMps : sliding_;
    }
    std::array<float, 3> string{};
    for (std::size_t axis = 0; axis < string.size(); ++axis) {
        string[axis] = state.placeMetres[axis] - (*pointMetres_)[axis];
    }
    const float distance = std::hypot(string[0], string[1], string[2]);
    if (!sliding_ && distance < (speed >= strokeMps ? strokeStartMetres : startMetres)) {
        return false;
    }
    if (distance > stringMetres) {
        for (std::size_t axis = 0; axis < string.size(); ++axis) {
            (*pointMetres_)[axis] += string[axis] * (1.0F - stringMetres / distance);
        }
        pulledSeconds_ = nowSeconds;
    }
    if (speed >= stopMps && nowSeconds - pulledSeconds_ <= holdSeconds) {
        return true;
    }
    pointMetres_ = state.placeMetres;
    return false;
}

namespace {

using effects::EffectKind;

constexpr effects::EffectMask surfaceEffects =
    effects::maskOf(EffectKind::texture) | effects::maskOf(EffectKind::impact) | effects::maskOf(EffectKind::edge);

ObjectIdentity objectOf(const ContactState& state) noexcept {
    return {.surfaceSeed = state.surfaceSeed, .variation = state.variation};
}

/// The heaviest material's seed that is nearest to a motion, scaled by its gain to the level of that motion; silence if
/// the material has no seed.
OnsetSeed seedFor(const Ingredients& ingredients, const Material& material, const RangedMotion& ranged,
                  float levelMps2) noexcept {
    OnsetSeed onset;
    const Seed* seed = retrieveSeed(ingredients.heaviest().material->seeds, ranged.motion);
    if (seed == nullptr) {
        return onset;
    }
    std::ranges::transform(seed->samples, onset.samplesMps2.begin(),
                           [scale = seed->gain * levelMps2](float sample) { return sample * scale; });
    // The seed plays as recorded, so its rib phase advances with its own velocity and not with the tip's.
    onset.ribs.vectors = waveVectorsOf(material.embedding);
    onset.ribs.phase = phasesFor(onset.ribs.vectors, waveVectorsOf(seed->embedding), seed->ribPhase);
    onset.ribs.cyclesPerSample = ribCyclesPerSample(material.embedding, seed->velocityMps[0], seed->velocityMps[1]);
    return onset;
}

}  // namespace

ContactPublisher::ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels,
                                   skeleton::NativeParts native)
    : library_(library), channels_(channels), native_(std::move(native)), events_(channels) {}

ContactAction ContactPublisher::publish(ContactState state) noexcept {
    VoiceCounters& counters = channels_.counters;
    counters.sanitised.fetch_add(sanitise(state), std::memory_order_relaxed);
    counters.updates.fetch_add(1, std::memory_order_relaxed);
    const double nowSeconds = channels_.clock();
    if (state.isMoving() != contact_.state.isMoving()) {
        movingSinceSeconds_ = nowSeconds;
    }
    const bool hasSignal = channels_.controls.signal.load(std::memory_order_relaxed).isSet();
    if (hasSignal) {
        state.effects &= ~surfaceEffects;
        events_.withdraw(surfaceEffects);
    }

    const ContactAction action = follower_.update(state, channels_.renderedSeconds.load(std::memory_order_relaxed));
    const bool isNewTouch = follower_.touches() != contact_.touch;
    const MaterialLibrary::ReadScope reading(library_);
    const Ingredients ingredients = reading.ingredients(state.material);
    const Material material = resolveMaterial(ingredients, isNewTouch ? WaveVectors{} : ribs_, objectOf(state));
    if (state.touching != 0) {
        ribs_ = waveVectorsOf(material.embedding);
    }
    contact_.state = state;
    contact_.publishedSeconds = nowSeconds;
    contact_.onset += action == ContactAction::onset || action == ContactAction::tap ? 1 : 0;
    contact_.touch = follower_.touches();
    contact_.sliding = follower_.sliding();
    contact_.updates += 1;
    contact_.slides += contact_.sliding ? 1 : 0;
    contact_.ranged =
        applyRangeLaw(library_.model().header(), material, state.velocityMps, state.forceNewtons, state.spatialScale);
    const MaterialInputs inputs{.embedding = material.embedding,
                                .waves = waveStatisticsOf(ingredients, waveVectorsOf(material.embedding)),
                                .level = requestLevel(ingredients, contact_.ranged),
                                .impulseGain = static_cast<float>(material.impulseGain)};
    // Every sliding state carries a seed or a sketch, because the callback may resume with any of them.
    if (contact_.sliding || action == ContactAction::tap) {
        contact_.levelMps2 = ingredients.levelMps2(contact_.ranged.levelMotion);
        if (native_.skeleton != nullptr) {
            prepareSketch(inputs);
        } else {
            seed_ = seedFor(ingredients, material, contact_.ranged, contact_.levelMps2);
        }
    }
    events_.follow(contact_, ingredients, reading.ingredients(events_.touched().material));
    if (action == ContactAction::rest && state.touching != 0) {
        counters.skipped.fetch_add(1, std::memory_order_relaxed);
    }

    channels_.publishedTouch.store(contact_.touch, std::memory_order_release);
    postToAudio(ingredients, inputs, hasSignal);
    postToWorker(ingredients, inputs);
    return action;
}

void ContactPublisher::prepareSketch(const MaterialInputs& inputs) noexcept {
    const std::array<float, 3>& motion = contact_.ranged.motion;
    skeleton::Phases phases = skeleton::phasesOf(inputs.embedding, motion, {});
    phases.back() = static_cast<float>(slipsPerSample(inputs.waves.slip, motion, 0.0) * inference::waveformRateHz);
    sketch_.parameters = native_.skeleton->parametersFor(skeleton::conditionOf(inputs.embedding, motion, phases),
                                                         skeleton::Skeleton::familiesOf(phases), inputs.impulseGain);
    if (inputs.level.levelMps2) {
        sketch_.levelMps2 = *inputs.level.levelMps2;
        return;
    }
    const float logLevel = native_.level->logLevel(inputs.embedding, inputs.level.motion);
    constexpr auto limit = static_cast<float>(inference::maximumLogLevel);
    // What is not a number is silent.
    const float limited = std::isfinite(logLevel) ? std::clamp(logLevel, -limit, limit) : -limit;
    sketch_.levelMps2 = std::exp(limited) * inputs.level.gain;
}

void ContactPublisher::postToAudio(const Ingredients& ingredients, const MaterialInputs& inputs,
                                   bool hasSignal) noexcept {
    const ContactState& state = contact_.state;
    const auto& motion = contact_.ranged.motion;
    std::optional<dsp::ToneCepstrum> tone;
    if (!hasSignal) {
        tone = resolveTone(ingredients, std::hypot(motion[0], motion[1]), static_cast<double>(motion[2]),
                           static_cast<double>(state.toneDbPerOctave), tiltPerDecibel_);
    }
    const effects::EffectMask requested =
        (state.effects & surfaceEffects) | (tone ? effects::maskOf(EffectKind::tone) : effects::EffectMask{0});
    channels_.counters.requestedEffects.store(state.touching != 0 ? requested : 0, std::memory_order_relaxed);

    AudioMessage& message = channels_.toAudio.draft();
    message.contact = contact_;
    message.seed = seed_;
    message.material = inputs;
    message.sketch = sketch_;
    message.contactEvents = events_.untaken();
    message.tone = tone ? std::optional(dsp::toneKernel(*tone)) : std::nullopt;
    message.movingSinceSeconds = movingSinceSeconds_;
    channels_.toAudio.post();
}

void ContactPublisher::postToWorker(const Ingredients& ingredients, const MaterialInputs& inputs) noexcept {
    WorkerMessage& message = channels_.toWorker.draft();
    message.contact = contact_;
    message.material = inputs;
    message.blend.count = 0;
    if (ingredients.isBlend()) {
        const double total = ingredients.totalWeight();
        for (const Ingredient& each : ingredients.all()) {
            BlendParts::Part& part = message.blend.parts[message.blend.count];
            part.share = static_cast<float>(each.weight / total);
            part.embedding = embeddingOf(*each.material, objectOf(contact_.state));
            part.impulseGain = each.material->label->impulseGain;
            part.slip = each.material->label->stickSlip.value_or(model::StickSlip{});
            ++message.blend.count;
        }
    }
    channels_.toWorker.post();
}

}  // namespace haptoflow::engine
