#include "engine/contact_publisher.hpp"

#include "engine/tap_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
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

constexpr effects::EffectMask surfaceEffects = effects::maskOf(EffectKind::texture) |
                                               effects::maskOf(EffectKind::impact) | effects::maskOf(EffectKind::edge) |
                                               effects::maskOf(EffectKind::relief);

ObjectIdentity objectOf(const ContactState& state) noexcept {
    return {.surfaceSeed = state.surfaceSeed, .variation = state.variation};
}

}  // namespace

ContactPublisher::ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels,
                                   StreamParameterMaker streams)
    : library_(library), channels_(channels), streams_(std::move(streams)), events_(channels) {}

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
    // Every sliding state carries what the stream plays, because the callback may resume with any of them.
    if (contact_.sliding || action == ContactAction::tap) {
        prepareStream(ingredients, material);
    }
    events_.follow(contact_, ingredients, reading.ingredients(events_.touched().material));
    if (action == ContactAction::rest && state.touching != 0) {
        counters.skipped.fetch_add(1, std::memory_order_relaxed);
    }

    channels_.publishedTouch.store(contact_.touch, std::memory_order_release);
    std::optional<dsp::ToneCepstrum> tone;
    if (!hasSignal) {
        const auto& motion = contact_.ranged.motion;
        tone = resolveTone(ingredients, std::hypot(motion[0], motion[1]), static_cast<double>(motion[2]),
                           static_cast<double>(state.toneDbPerOctave), tiltPerDecibel_);
    }
    followRelief(ingredients);
    post(tone);
    return action;
}

void ContactPublisher::followRelief(const Ingredients& ingredients) noexcept {
    const ContactState& state = contact_.state;
    const bool isFelt = state.touching != 0 && state.hasEffect(EffectKind::relief);
    reliefs().follow(isFelt ? state.relief : 0, reliefNumber_, reliefEdition_, relief_);
    if (relief_ != nullptr) {
        reliefStiffness_ = stiffnessOf(ingredients);
    }
}

void ContactPublisher::prepareStream(const Ingredients& ingredients, const Material& material) noexcept {
    contact_.levelMps2 = ingredients.levelMps2(contact_.ranged.levelMotion);
    material_ = {.embedding = material.embedding,
                 .level = requestLevel(ingredients, contact_.ranged),
                 .impulseGain = static_cast<float>(material.impulseGain)};
    std::array<double, 2> seedPhase{};
    if (const Seed* seed = retrieveSeed(ingredients.heaviest().material->seeds, contact_.ranged.motion)) {
        const auto scaled = [&seed](auto samples, auto& out, float scale) {
            std::ranges::transform(samples, out.begin(),
                                   [gain = seed->gain * scale](float sample) { return sample * gain; });
        };
        scaled(seed->samples.first<inference::segmentSamples>(), material_.pastMps2, contact_.levelMps2);
        scaled(seed->samples.last<inference::segmentSamples>(), material_.beginningUnit, 1.0F);
        seedPhase = seed->ribPhase;
    }
    stream_ = streams_.make(contact_, material_, ingredients, channels_.renderedSeconds.load(std::memory_order_relaxed),
                            seedPhase);
}

void ContactPublisher::post(const std::optional<dsp::ToneCepstrum>& tone) noexcept {
    const ContactState& state = contact_.state;
    const effects::EffectMask requested =
        (state.effects & surfaceEffects) | (tone ? effects::maskOf(EffectKind::tone) : effects::EffectMask{0});
    channels_.counters.requestedEffects.store(state.touching != 0 ? requested : 0, std::memory_order_relaxed);

    const std::optional<dsp::ToneKernel> kernel = tone ? std::optional(dsp::toneKernel(*tone)) : std::nullopt;
    for (Mailbox<ContactMessage>* mailbox : {&channels_.toAudio, &channels_.toWorker}) {
        ContactMessage& message = mailbox->draft();
        message.contact = contact_;
        message.material = material_;
        message.stream = stream_;
        message.contactEvents = events_.untaken();
        message.tone = kernel;
        if (mailbox == &channels_.toAudio) {
            message.relief = relief_;
            message.reliefStiffness = reliefStiffness_;
        }
        message.movingSinceSeconds = movingSinceSeconds_;
        mailbox->post();
    }
}

}  // namespace haptoflow::engine
