#include "engine/contact_publisher.hpp"

#include "engine/impact_responses.hpp"
#include "engine/material.hpp"
#include "engine/range_law.hpp"
#include "engine/seed_retrieval.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;

constexpr effects::EffectMask surfaceEffects =
    effects::maskOf(EffectKind::texture) | effects::maskOf(EffectKind::impact) | effects::maskOf(EffectKind::edge);
// An edge is a blow at this share of the speed along the surface where it is as high as the second figure, or where the
// level changes by the third: a step as high as a stylus's tip is wide, and a change from smooth to rough.
constexpr double edgeShareOfSpeed = 0.2;
constexpr double fullEdgeMetres = 0.002;
constexpr double fullEdgeDb = 20.0;

}  // namespace

ContactPublisher::ContactPublisher(const model::ModelFile& model, const OnsetLevels& levels,
                                   VoiceChannels& channels) noexcept
    : model_(model), levels_(levels), channels_(channels) {}

ContactAction ContactPublisher::publish(ContactState state) noexcept {
    VoiceCounters& counters = channels_.counters;
    counters.sanitised.fetch_add(sanitise(state), std::memory_order_relaxed);
    counters.updates.fetch_add(1, std::memory_order_relaxed);

    const std::uint64_t touchesBefore = follower_.touches();
    const ContactAction action = follower_.update(state);
    const Material material = resolveMaterial(model_, state.material);
    const RangedMotion ranged = applyRangeLaw(model_.header(), material, state.velocityMps, state.forceNewtons);
    onsets_ += action == ContactAction::onset || action == ContactAction::tap ? 1 : 0;
    // With every state that slides, not only at touch-down: the callback may have to resume with any of them.
    if (follower_.sliding() || action == ContactAction::tap) {
        retrieve(state, material.dominantLabel, ranged.motion);
    }
    counters.askedFor.store(state.touching ? state.effects & surfaceEffects : 0, std::memory_order_relaxed);
    const bool isNewTouch = follower_.touches() != touchesBefore;
    noteSpeed(state, isNewTouch);
    if (isNewTouch) {
        // The counter stays the same where a surface without label interrupts a touch: that touch has landed already.
        if (state.touchCounter != lastTouchCounter_) {
            noteImpact(state);
        }
    } else if (wasTouching_) {
        noteTransition(state, material.dominantLabel, ranged.motion);
    }
    remember(state, material.dominantLabel);
    if (action == ContactAction::rest && state.touching) {
        counters.skipped.fetch_add(1, std::memory_order_relaxed);
    }

    channels_.publishedTouch.store(follower_.touches(), std::memory_order_release);
    AudioMessage& audio = channels_.toAudio.draft();
    audio.onset = onsets_;
    audio.touch = follower_.touches();
    audio.sliding = follower_.sliding();
    audio.levelGain = static_cast<float>(ranged.levelGain);
    audio.readingRate = ranged.readingRate;
    audio.seedMps2 = seedMps2_;
    audio.seedRibs = seedRibs_;
    audio.impact = impact_;
    audio.edge = edge_;
    channels_.toAudio.post();

    slides_ += follower_.sliding() ? 1 : 0;
    WorkerMessage& worker = channels_.toWorker.draft();
    worker.onset = onsets_;
    worker.sliding = follower_.sliding();
    worker.slides = slides_;
    worker.embedding = material.embedding;
    worker.motion = ranged.motion;
    worker.readingRate = ranged.readingRate;
    channels_.toWorker.post();
    return action;
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

void ContactPublisher::remember(const ContactState& state, std::size_t dominantLabel) noexcept {
    wasTouching_ = state.touching;
    lastTouchCounter_ = state.touchCounter;
    lastEdgeCounter_ = state.edgeCounter;
    lastLandingCounter_ = state.landingCounter;
    if (state.touching) {
        last_ = state;
        lastLabel_ = dominantLabel;
    }
}

void ContactPublisher::noteImpact(const ContactState& state) noexcept {
    if (!state.asksFor(EffectKind::impact) || !(state.approachSpeedMps > 0.0F)) {
        return;
    }
    ++impact_.counter;
    impact_.speedMps = state.approachSpeedMps;
    impact_.response = impactResponse(model_, state.material);
}

void ContactPublisher::noteTransition(const ContactState& state, std::size_t dominantLabel,
                                      const std::array<float, 3>& motion) noexcept {
    if (!state.touching) {
        // The tip has slid off what it touched: that surface's edge, at the speed that the tip had there.
        strikeEdge(last_, heightShare(state));
        return;
    }
    if (state.landingCounter != lastLandingCounter_) {
        noteImpact(state);
        return;
    }
    strikeEdge(state, std::max(heightShare(state), levelShare(state, dominantLabel, motion)));
}

double ContactPublisher::heightShare(const ContactState& state) const noexcept {
    return state.edgeCounter == lastEdgeCounter_ ? 0.0 : static_cast<double>(state.edgeHeightMetres) / fullEdgeMetres;
}

double ContactPublisher::levelShare(const ContactState& state, std::size_t dominantLabel,
                                    const std::array<float, 3>& motion) const noexcept {
    if (dominantLabel == lastLabel_) {
        return 0.0;
    }
    const auto before = static_cast<double>(levels_.at(last_.material, motion));
    const auto after = static_cast<double>(levels_.at(state.material, motion));
    return std::abs(20.0 * std::log10(std::max(after, 1e-6) / std::max(before, 1e-6))) / fullEdgeDb;
}

void ContactPublisher::strikeEdge(const ContactState& state, double share) noexcept {
    const double speedMps = std::ranges::max(newestSpeedsMps_);
    const double blowMps = edgeShareOfSpeed * speedMps * std::min(share, 1.0);
    if (!state.asksFor(EffectKind::edge) || !(blowMps > 0.0)) {
        return;
    }
    ++edge_.counter;
    edge_.speedMps = static_cast<float>(blowMps);
    edge_.response = impactResponse(model_, state.material);
}

void ContactPublisher::retrieve(const ContactState& state, std::size_t label,
                                const std::array<float, 3>& motion) noexcept {
    seedMps2_.fill(0.0F);
    seedRibs_ = {};
    const std::optional<std::size_t> chosen = retrieveSeed(model_, label, motion);
    if (!chosen) {
        return;
    }
    const float levelMps2 = levels_.at(state.material, motion);
    std::ranges::transform(model_.seed(*chosen), seedMps2_.begin(),
                           [levelMps2](float sample) { return sample * levelMps2; });
    // The seed sounds as recorded: it goes on over its ribs by its own velocity, whatever the hand's is.
    const model::SeedEntry& seed = model_.header().seeds[*chosen];
    seedRibs_.phase = seed.ribPhase;
    seedRibs_.turnsPerSample = ribTurnsPerSample(model_.embedding(label), seed.velocityMps[0], seed.velocityMps[1]);
}

}  // namespace haptoflow::engine
