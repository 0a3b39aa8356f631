#include "engine/contact_publisher.hpp"

#include "engine/impact_responses.hpp"
#include "engine/level_request.hpp"
#include "engine/seed_retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;

constexpr effects::EffectMask surfaceEffects =
    effects::maskOf(EffectKind::texture) | effects::maskOf(EffectKind::impact) | effects::maskOf(EffectKind::edge);
// A full edge is a blow at this share of the speed along the surface. An edge is full if its height reaches the width
// of a stylus tip, or if the level changes by 20 dB, as from a smooth to a rough material; smaller edges are in
// proportion.
constexpr double edgeShareOfSpeed = 0.2;
constexpr double fullEdgeMetres = 0.002;
constexpr double fullEdgeDb = 20.0;

}  // namespace

ContactPublisher::ContactPublisher(const MaterialLibrary& library, VoiceChannels& channels)
    : library_(library), channels_(channels) {}

ContactAction ContactPublisher::publish(ContactState state) noexcept {
    VoiceCounters& counters = channels_.counters;
    counters.sanitised.fetch_add(sanitise(state), std::memory_order_relaxed);
    counters.updates.fetch_add(1, std::memory_order_relaxed);
    ++updates_;
    blows_.removeUpTo(channels_.takenBlow.load(std::memory_order_acquire));
    noteMotion(state);
    const bool hasSignal = channels_.controls.signal.load(std::memory_order_relaxed).isSet();
    if (hasSignal) {
        state.effects &= ~surfaceEffects;
        last_.effects &= ~surfaceEffects;
    }

    const std::uint64_t touchesBefore = follower_.touches();
    const ContactAction action = follower_.update(state);
    const bool isNewTouch = follower_.touches() != touchesBefore;
    const MaterialLibrary::ReadScope reading(library_);
    Contact contact{.state = state,
                    .ingredients = reading.ingredients(state.material),
                    .before = reading.ingredients(last_.material),
                    .ranged = {},
                    .hasSignal = hasSignal};
    const Material material = resolveMaterial(contact.ingredients, isNewTouch ? WaveVectors{} : ribs_);
    contact.ranged =
        applyRangeLaw(library_.model().header(), material, state.velocityMps, state.forceNewtons, state.spatialScale);
    if (state.touching) {
        ribs_ = waveVectorsOf(material.embedding);
    }
    onsets_ += action == ContactAction::onset || action == ContactAction::tap ? 1 : 0;
    // Every sliding state carries a seed, because the callback may resume with any of them.
    if (follower_.sliding() || action == ContactAction::tap) {
        retrieve(contact, material);
    }
    noteSpeed(state, isNewTouch);
    if (isNewTouch) {
        // An unchanged counter means that a surface without a label interrupted the touch, which has landed before. A
        // counter of 0 is that of a caller who does not count, or of the first touch of one who counts from 0.
        if (state.touchCounter != lastTouchCounter_ || state.touchCounter == 0) {
            noteImpact(contact);
        }
    } else if (wasTouching_) {
        noteTransition(contact);
    }
    remember(contact);
    if (action == ContactAction::rest && state.touching) {
        counters.skipped.fetch_add(1, std::memory_order_relaxed);
    }

    channels_.publishedTouch.store(follower_.touches(), std::memory_order_release);
    postToAudio(contact);
    postToWorker(contact, material);
    return action;
}

void ContactPublisher::postToAudio(const Contact& contact) noexcept {
    const auto& motion = contact.ranged.motion;
    std::optional<dsp::ToneCepstrum> tone;
    if (!contact.hasSignal) {
        tone = resolveTone(contact.ingredients, std::hypot(motion[0], motion[1]),
                           static_cast<double>(contact.state.toneDbPerOctave), tiltPerDecibel_);
    }
    const effects::EffectMask requested =
        (contact.state.effects & surfaceEffects) | (tone ? effects::maskOf(EffectKind::tone) : effects::EffectMask{0});
    channels_.counters.requestedEffects.store(contact.state.touching ? requested : 0, std::memory_order_relaxed);

    AudioMessage& audio = channels_.toAudio.draft();
    audio.onset = onsets_;
    audio.touch = follower_.touches();
    audio.sliding = follower_.sliding();
    audio.levelGain = static_cast<float>(contact.ranged.levelGain);
    audio.readingRate = contact.ranged.readingRate;
    audio.seedMps2 = seedMps2_;
    audio.seedRibs = seedRibs_;
    audio.updates = updates_;
    audio.blows = blows_;
    audio.hasTone = tone.has_value();
    audio.tone = tone ? dsp::toneKernel(*tone) : dsp::ToneKernel{};
    audio.isMoving = isMoving_;
    audio.movingSinceSeconds = movingSinceSeconds_;
    channels_.toAudio.post();
}

void ContactPublisher::postToWorker(const Contact& contact, const Material& material) noexcept {
    slides_ += follower_.sliding() ? 1 : 0;
    WorkerMessage& worker = channels_.toWorker.draft();
    worker.onset = onsets_;
    worker.sliding = follower_.sliding();
    worker.slides = slides_;
    worker.embedding = material.embedding;
    worker.motion = contact.ranged.motion;
    worker.readingRate = contact.ranged.readingRate;
    worker.level = requestLevel(contact.ingredients, contact.ranged);
    worker.blend.count = 0;
    if (contact.ingredients.isBlend()) {
        const double total = contact.ingredients.totalWeight();
        for (const Ingredient& each : contact.ingredients.all()) {
            BlendParts::Part& part = worker.blend.parts[worker.blend.count];
            part.share = static_cast<float>(each.weight / total);
            std::ranges::copy(each.material->embedding, part.embedding.begin());
            ++worker.blend.count;
        }
    }
    channels_.toWorker.post();
}

void ContactPublisher::noteMotion(const ContactState& state) noexcept {
    const bool isMoving = state.touching && std::hypot(state.velocityMps[0], state.velocityMps[1]) >= signalSpeedMps;
    if (isMoving != isMoving_) {
        isMoving_ = isMoving;
        movingSinceSeconds_ = channels_.clock();
    }
}

void ContactPublisher::noteSpeed(const ContactState& state, bool isNewTouch) noexcept {
    if (isNewTouch) {
        newestSpeedsMps_.fill(0.0);
    }
    if (state.touching) {
        std::ranges::rotate(newestSpeedsMps_, newestSpeedsMps_.begin() + 1);
        newestSpeedsMps_.back() = std::hypot(state.velocityMps[0], state.velocityMps[1]);
    }
}

void ContactPublisher::remember(const Contact& contact) noexcept {
    const ContactState& state = contact.state;
    wasTouching_ = state.touching;
    lastTouchCounter_ = state.touchCounter;
    lastEdgeCounter_ = state.edgeCounter;
    lastLandingCounter_ = state.landingCounter;
    if (state.touching) {
        last_ = state;
        lastLabel_ = contact.ingredients.heaviest().index;
    }
}

void ContactPublisher::noteImpact(const Contact& contact) noexcept {
    const ContactState& state = contact.state;
    if (!state.hasEffect(EffectKind::impact) || !(state.approachSpeedMps > 0.0F)) {
        return;
    }
    addBlow(EffectKind::impact, state.approachSpeedMps, contact.ingredients);
}

void ContactPublisher::addBlow(EffectKind kind, float speedMps, const Ingredients& ingredients) noexcept {
    const Blow blow{.number = ++blowCount_,
                    .update = updates_,
                    .touch = follower_.touches(),
                    .publishedSeconds = channels_.clock(),
                    .kind = kind,
                    .speedMps = speedMps,
                    .response = impactResponse(ingredients)};
    if (!blows_.add(blow)) {
        channels_.counters.lostBlows.fetch_add(1, std::memory_order_relaxed);
    }
}

void ContactPublisher::noteTransition(const Contact& contact) noexcept {
    const ContactState& state = contact.state;
    if (!state.touching) {
        // The tip has slid off the last surface: strike that surface's edge at the tip's last speed.
        strikeEdge(last_, contact.before, heightShare(state));
        return;
    }
    if (state.landingCounter != lastLandingCounter_) {
        noteImpact(contact);
        return;
    }
    strikeEdge(state, contact.ingredients, std::max(heightShare(state), levelShare(contact)));
}

double ContactPublisher::heightShare(const ContactState& state) const noexcept {
    return state.edgeCounter == lastEdgeCounter_ ? 0.0 : static_cast<double>(state.edgeHeightMetres) / fullEdgeMetres;
}

double ContactPublisher::levelShare(const Contact& contact) const noexcept {
    if (contact.ingredients.heaviest().index == lastLabel_) {
        return 0.0;
    }
    const auto& motion = contact.ranged.levelMotion;
    const auto before = static_cast<double>(contact.before.levelMps2(motion));
    const auto after = static_cast<double>(contact.ingredients.levelMps2(motion));
    return std::abs(20.0 * std::log10(std::max(after, 1e-6) / std::max(before, 1e-6))) / fullEdgeDb;
}

void ContactPublisher::strikeEdge(const ContactState& state, const Ingredients& ingredients, double share) noexcept {
    const double speedMps = std::ranges::max(newestSpeedsMps_);
    const double blowMps = edgeShareOfSpeed * speedMps * std::min(share, 1.0);
    if (!state.hasEffect(EffectKind::edge) || !(blowMps > 0.0)) {
        return;
    }
    addBlow(EffectKind::edge, static_cast<float>(blowMps), ingredients);
}

void ContactPublisher::retrieve(const Contact& contact, const Material& material) noexcept {
    seedMps2_.fill(0.0F);
    seedRibs_ = {};
    const Seed* seed = retrieveSeed(contact.ingredients.heaviest().material->seeds, contact.ranged.motion);
    if (seed == nullptr) {
        return;
    }
    const float levelMps2 = contact.ingredients.levelMps2(contact.ranged.levelMotion);
    std::ranges::transform(seed->samples, seedMps2_.begin(), [levelMps2](float sample) { return sample * levelMps2; });
    // The seed plays as recorded, so its rib phase advances with its own velocity and not with the tip's.
    seedRibs_.vectors = waveVectorsOf(material.embedding);
    seedRibs_.phase = phasesFor(seedRibs_.vectors, waveVectorsOf(seed->embedding), seed->ribPhase);
    seedRibs_.turnsPerSample = ribTurnsPerSample(material.embedding, seed->velocityMps[0], seed->velocityMps[1]);
}

}  // namespace haptoflow::engine
