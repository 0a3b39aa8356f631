#pragma once

#include "dsp/tone_filter.hpp"
#include "engine/blend_balance.hpp"
#include "engine/contact_blows.hpp"
#include "engine/contact_state.hpp"
#include "engine/range_law.hpp"
#include "engine/rib_phase.hpp"
#include "engine/seam_statistics.hpp"
#include "engine/waveform_timeline.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/skeleton.hpp"

#include <array>
#include <cstdint>
#include <optional>

namespace haptoflow::engine {

/// A published contact. The callback and the worker both receive all of it, so that a field added to the state reaches
/// both: the state itself, and the values that the publisher derived from it.
struct PublishedContact {
    /// Sanitised; without effects while a signal replaces them.
    ContactState state;
    /// Increases by 1 at each onset: touch-down, or sliding resumed.
    std::uint32_t onset = 0;
    /// ContactFollower::touches. A panic silences a whole touch, including sliding that resumes in it.
    std::uint64_t touch = 0;
    bool sliding = false;
    /// Number of states published so far, this one included, and of those that slide.
    std::uint64_t updates = 0;
    std::uint64_t slides = 0;
    RangedMotion ranged;
    /// The materials' level for the motion, before the range law's gain; that of the newest sliding state.
    float levelMps2 = 1.0F;
    /// VoiceChannels::clock when it was published.
    double publishedSeconds = 0.0;
};

/// What skeleton and networks are told of a contact's materials.
struct MaterialInputs {
    std::array<float, inference::embeddingSize> embedding{};
    WaveStatistics waves;
    LevelRequest level;
    float impulseGain = 1.0F;
};

/// What a skeleton makes of a contact: its parameters, and the level before a blend's balance. The publisher prepares
/// it, because the weights would push the callback's own data out of the cache. Empty for a model without a skeleton.
struct PreparedSketch {
    skeleton::SegmentParameters parameters;
    float levelMps2 = 0.0F;
};

/// A seed, ready to be played.
struct OnsetSeed {
    std::array<float, WaveformTimeline::seedSamples> samplesMps2{};
    SeedRibs ribs{};
};

/// A contact for the callback, with the seed, the blows and the tone, which the callback plays without the worker. The
/// publisher prepares these, because looking up a material may wait and the callback must not.
struct AudioMessage {
    PublishedContact contact;
    /// The seed for the newest sliding state. Every message contains it, so that an onset is not lost if its message is
    /// replaced, and a touch resumes with the seed of the state with which it resumes. Silent for a model with a
    /// skeleton, which needs none.
    OnsetSeed seed;
    MaterialInputs material;
    /// That of the newest sliding state, as the seed.
    PreparedSketch sketch;
    /// The blows that the callback had not taken when the message was written, so that no blow is lost if its message
    /// is replaced.
    BlowList blows;
    std::optional<dsp::ToneKernel> tone;
    /// Time of the last change of ContactState::isMoving (VoiceChannels::clock).
    double movingSinceSeconds = 0.0;
};

/// A contact for the worker, with the inputs of the network that follow from the materials. It exists beside
/// PublishedContact because a material may be replaced while the worker runs; an inference::SegmentRequest adds the
/// past and the noise, which only the worker knows.
struct WorkerMessage {
    PublishedContact contact;
    MaterialInputs material;
    BlendParts blend;
};

}  // namespace haptoflow::engine
