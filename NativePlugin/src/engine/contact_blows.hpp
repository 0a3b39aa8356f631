#pragma once

#include "effects/effect.hpp"
#include "effects/strikes.hpp"
#include "engine/contact_messages.hpp"
#include "engine/material_library.hpp"
#include "engine/voice_channels.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace haptoflow::engine {

/// An impact or an edge, on its way from the publisher to the callback.
struct Blow {
    /// Number of the blow among the voice's blows, from 1.
    std::uint64_t number = 0;
    /// Number of the state that caused it among the published states, from 1.
    std::uint64_t update = 0;
    /// ContactFollower::touches. A panic silences the blows of a whole touch.
    std::uint64_t touch = 0;
    /// VoiceChannels::clock at its publication.
    double publishedSeconds = 0.0;
    effects::EffectKind kind = effects::EffectKind::impact;
    float speedMps = 0.0F;
    effects::ImpactResponse response{};
};

/// Blows in the order of their publication. Of more blows than it holds, it keeps the strongest. Allocates nothing.
class BlowList {
public:
    /// Enough for a blow with each of 1000 states per second in a block of 2048 frames at 32 kHz.
    static constexpr std::size_t capacity = 64;

    BlowList() = default;
    BlowList(const BlowList& other) noexcept { *this = other; }
    /// Copies only the blows in use, because every published state copies the list.
    BlowList& operator=(const BlowList& other) noexcept {
        if (this != &other) {
            count_ = other.count_;
            std::ranges::copy(other.all(), blows_.begin());
        }
        return *this;
    }
    ~BlowList() = default;

    [[nodiscard]] std::span<const Blow> all() const noexcept { return std::span(blows_).first(count_); }

    /// Appends a blow. Returns false if one was lost: the weakest of those in a full list and the new one.
    [[nodiscard]] bool add(const Blow& blow) noexcept {
        if (count_ < capacity) {
            blows_[count_] = blow;
            ++count_;
            return true;
        }
        const auto weakest = std::ranges::min_element(blows_, {}, &Blow::speedMps);
        if (weakest->speedMps < blow.speedMps) {
            std::rotate(weakest, weakest + 1, blows_.end());
            blows_.back() = blow;
        }
        return false;
    }

    /// Removes the blows up to the one of this number.
    void removeUpTo(std::uint64_t number) noexcept {
        const auto kept = std::ranges::find_if(all(), [number](const Blow& blow) { return blow.number > number; });
        const auto removed = static_cast<std::size_t>(kept - all().begin());
        std::ranges::copy(all().subspan(removed), blows_.begin());
        count_ -= removed;
    }

private:
    std::array<Blow, capacity> blows_{};
    std::size_t count_ = 0;
};

/// Finds the impacts and edges between successive states of one voice, and keeps them until the callback has taken
/// them. Wait-free, allocates nothing; used by one thread at a time.
class ContactBlows {
public:
    explicit ContactBlows(VoiceChannels& channels) noexcept : channels_(channels) {}

    /// Adds the blow, if any, between the last state and this one. `materials` are those of this state, `before` those
    /// of `touched`.
    void follow(const PublishedContact& contact, const Ingredients& materials, const Ingredients& before) noexcept;
    /// The last touching state.
    [[nodiscard]] const ContactState& touched() const noexcept { return touched_; }
    /// Removes these effects from the last touching state: the tip gets no edge for sliding off it.
    void withdraw(effects::EffectMask effects) noexcept { touched_.effects &= ~effects; }
    /// The blows that the callback had not taken at the last state.
    [[nodiscard]] const BlowList& untaken() const noexcept { return blows_; }

private:
    void noteTransition(const PublishedContact& contact, const Ingredients& materials,
                        const Ingredients& before) noexcept;
    void strikeImpact(const PublishedContact& contact, const Ingredients& materials) noexcept;
    /// Strikes an edge of the surface of `state` at the largest of the newest speeds. `share` is the share of a full
    /// edge.
    void strikeEdge(const PublishedContact& contact, const ContactState& state, const Ingredients& materials,
                    double share) noexcept;
    void add(const PublishedContact& contact, effects::EffectKind kind, float speedMps,
             const Ingredients& materials) noexcept;
    /// The newest edge as a share of a full edge, by its height or by the change of level from the last label; may
    /// exceed 1.
    [[nodiscard]] double heightShare(const ContactState& state) const noexcept;
    [[nodiscard]] double levelShare(const PublishedContact& contact, const Ingredients& materials,
                                    const Ingredients& before) const noexcept;

    VoiceChannels& channels_;
    BlowList blows_;
    std::uint64_t count_ = 0;
    // The last contact, the last touching state and its heaviest material.
    PublishedContact last_;
    ContactState touched_;
    std::uint32_t touchedLabel_ = 0;
    // Speeds of the newest states of this touch. An edge is struck at the largest of them, because on a rounded rim the
    // surface normal points along the motion for a few states, and the speed along the surface is near 0.
    std::array<double, 4> newestSpeedsMps_{};
};

}  // namespace haptoflow::engine
