#pragma once

#include "dsp/tone_filter.hpp"
#include "effects/effect.hpp"
#include "effects/impacts.hpp"
#include "effects/relief_map.hpp"
#include "engine/contact_state.hpp"
#include "engine/material.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/stream.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
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
    /// The materials' tabulated level for the motion, before the range law's gain; that of the newest sliding state.
    float levelMps2 = 1.0F;
    /// VoiceChannels::clock when it was published.
    double publishedSeconds = 0.0;
};

/// What networks are told of a contact's materials.
struct MaterialInputs {
    std::array<float, inference::embeddingSize> embedding{};
    LevelRequest level;
    float impulseGain = 1.0F;
    /// The nearest recording of a model without a skeleton, or silence: 100 ms in m/s^2 that a network continues first,
    /// and the next 100 ms in unit scale, which sound until its first segment is there.
    std::array<float, inference::segmentSamples> pastMps2{};
    std::array<float, inference::segmentSamples> beginningUnit{};
};

/// A contact on its way from the publisher to the callback, and another copy to the worker: its materials may be
/// replaced meanwhile, and looking them up may wait.
struct ContactMessage {
    PublishedContact contact;
    MaterialInputs material;
    /// Those of the newest sliding state, so that a touch resumes with the state with which it resumes.
    skeleton::StreamParameters stream;
    /// The contact events that the callback had not taken when the message was written, so that no event is lost if its
    /// message is replaced.
    ContactEventList contactEvents;
    std::optional<dsp::ToneKernel> tone;
    /// The relief under the tip, for the callback alone: its slot of the mailbox keeps the map, and the publisher frees
    /// one that nobody else keeps.
    std::shared_ptr<const effects::ReliefMap> relief;
    double reliefStiffness = 0.0;
    /// Time of the last change of ContactState::isMoving (VoiceChannels::clock).
    double movingSinceSeconds = 0.0;
};

}  // namespace haptoflow::engine
