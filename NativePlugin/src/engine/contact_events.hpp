#pragma once

#include "effects/effect.hpp"
#include "engine/contact_messages.hpp"
#include "engine/material_library.hpp"
#include "engine/voice_channels.hpp"

#include <array>
#include <cstdint>

namespace haptoflow::engine {

/// Finds the impacts and edges between successive states of one voice, and keeps them until the callback has taken
/// them. Wait-free, allocates nothing; used by one thread at a time.
class ContactEvents {
public:
    explicit ContactEvents(VoiceChannels& channels) noexcept : channels_(channels) {}

    /// Adds the contact event, if any, between the last state and this one. `materials` are those of this state,
    /// `before` those of `touched`.
    void follow(const PublishedContact& contact, const Ingredients& materials, const Ingredients& before) noexcept;
    /// The last touching state.
    [[nodiscard]] const ContactState& touched() const noexcept { return touched_; }
    /// Removes these effects from the last touching state: the tip gets no edge for sliding off it.
    void withdraw(effects::EffectMask effects) noexcept { touched_.effects &= ~effects; }
    /// The contact events that the callback had not taken at the last state.
    [[nodiscard]] const ContactEventList& untaken() const noexcept { return events_; }

private:
    void noteTransition(const PublishedContact& contact, const Ingredients& materials,
                        const Ingredients& before) noexcept;
    void addImpact(const PublishedContact& contact, const Ingredients& materials) noexcept;
    /// Impacts an edge of the surface of `state` at the largest of the newest speeds. `share` is the share of a full
    /// edge.
    void addEdge(const PublishedContact& contact, const ContactState& state, const Ingredients& materials,
                 double share) noexcept;
    void add(const PublishedContact& contact, effects::EffectKind kind, float speedMps,
             const Ingredients& materials) noexcept;
    /// The newest edge as a share of a full edge, by its height or by the change of level from the last label; may
    /// exceed 1.
    [[nodiscard]] double heightShare(const ContactState& state) const noexcept;
    [[nodiscard]] double levelShare(const PublishedContact& contact, const Ingredients& materials,
                                    const Ingredients& before) const noexcept;

    VoiceChannels& channels_;
    ContactEventList events_;
    std::uint64_t count_ = 0;
    // The last contact, the last touching state and its heaviest material.
    PublishedContact last_;
    ContactState touched_;
    std::uint32_t touchedLabel_ = 0;
    // Speeds of the newest states of this touch. An edge sounds by the largest of them, because on a rounded rim the
    // surface normal points along the motion for a few states, and the speed along the surface is near 0.
    std::array<double, 4> newestSpeedsMps_{};
};

}  // namespace haptoflow::engine
