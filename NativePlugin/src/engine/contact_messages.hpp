#pragma once

#include "dsp/tone_filter.hpp"
#include "effects/effect.hpp"
#include "effects/impacts.hpp"
#include "engine/blend_balance.hpp"
#include "engine/contact_state.hpp"
#include "engine/range_law.hpp"
#include "engine/rib_phase.hpp"
#include "engine/seam_statistics.hpp"
#include "engine/waveform_timeline.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/skeleton.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace haptoflow::engine {

/// An impact or an edge, on its way from the publisher to the callback.
struct ContactEvent {
    /// Number of the contact event among the voice's contact events, from 1.
    std::uint64_t number = 0;
    /// Number of the state that caused it among the published states, from 1.
    std::uint64_t update = 0;
    /// ContactFollower::touches. A panic silences the contact events of a whole touch.
    std::uint64_t touch = 0;
    /// VoiceChannels::clock at its publication.
    double publishedSeconds = 0.0;
    effects::EffectKind kind = effects::EffectKind::impact;
    float speedMps = 0.0F;
    effects::ImpactResponse response{};
};

/// ContactEvents in the order of their publication. Of more contact events than it holds, it keeps the strongest.
/// Allocates nothing.
class ContactEventList {
public:
    /// Enough for a contact event with each of 1000 states per second in a block of 2048 frames at 32 kHz.
    static constexpr std::size_t capacity = 64;

    ContactEventList() = default;
    ContactEventList(const ContactEventList& other) noexcept { *this = other; }
    /// Copies only the contact events in use, because every published state copies the list.
    ContactEventList& operator=(const ContactEventList& other) noexcept {
        if (this != &other) {
            count_ = other.count_;
            std::ranges::copy(other.all(), events_.begin());
        }
        return *this;
    }
    ~ContactEventList() = default;

    [[nodiscard]] std::span<const ContactEvent> all() const noexcept { return std::span(events_).first(count_); }

    /// Appends a contact event. Returns false if one was lost: the weakest of those in a full list and the new one.
    [[nodiscard]] bool add(const ContactEvent& event) noexcept {
        if (count_ < capacity) {
            events_[count_] = event;
            ++count_;
            return true;
        }
        const auto weakest = std::ranges::min_element(events_, {}, &ContactEvent::speedMps);
        if (weakest->speedMps < event.speedMps) {
            std::rotate(weakest, weakest + 1, events_.end());
            events_.back() = event;
        }
        return false;
    }

    /// Removes the contact events up to the one of this number.
    void removeUpTo(std::uint64_t number) noexcept {
        const auto kept =
            std::ranges::find_if(all(), [number](const ContactEvent& event) { return event.number > number; });
        const auto removed = static_cast<std::size_t>(kept - all().begin());
        std::ranges::copy(all().subspan(removed), events_.begin());
        count_ -= removed;
    }

private:
    std::array<ContactEvent, capacity> events_{};
    std::size_t count_ = 0;
};

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

/// A contact for the callback, with the seed, the contact events and the tone, which the callback plays without the
/// worker. The publisher prepares these, because looking up a material may wait and the callback must not.
struct AudioMessage {
    PublishedContact contact;
    /// The seed for the newest sliding state. Every message contains it, so that an onset is not lost if its message is
    /// replaced, and a touch resumes with the seed of the state with which it resumes. Silent for a model with a
    /// skeleton, which needs none.
    OnsetSeed seed;
    MaterialInputs material;
    /// That of the newest sliding state, as the seed.
    PreparedSketch sketch;
    /// The contact events that the callback had not taken when the message was written, so that no event is lost if its
    /// message is replaced.
    ContactEventList contactEvents;
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
