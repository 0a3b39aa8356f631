#include "engine/contact_publisher.hpp"

#include "engine/material.hpp"
#include "engine/range_law.hpp"
#include "engine/seed_retrieval.hpp"

#include <algorithm>
#include <optional>

namespace haptoflow::engine {

ContactPublisher::ContactPublisher(const model::ModelFile& model, const OnsetLevels& levels,
                                   VoiceChannels& channels) noexcept
    : model_(model), levels_(levels), channels_(channels) {}

ContactAction ContactPublisher::publish(ContactState state) noexcept {
    VoiceCounters& counters = channels_.counters;
    counters.sanitised.fetch_add(sanitise(state), std::memory_order_relaxed);
    counters.updates.fetch_add(1, std::memory_order_relaxed);

    const ContactAction action = follower_.update(state);
    const Material material = resolveMaterial(model_, state.material);
    const RangedMotion ranged = applyRangeLaw(model_.header(), material, state.velocityMps, state.forceNewtons);
    onsets_ += action == ContactAction::onset || action == ContactAction::tap ? 1 : 0;
    // With every state that slides, not only at touch-down: the callback may have to resume with any of them.
    if (follower_.sliding() || action == ContactAction::tap) {
        retrieve(state, material.dominantLabel, ranged.motion);
    }
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
