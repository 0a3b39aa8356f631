#pragma once

#include "effects/effect.hpp"
#include "effects/strikes.hpp"

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

}  // namespace haptoflow::engine
