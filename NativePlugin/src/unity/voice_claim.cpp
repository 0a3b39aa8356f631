#include "unity/voice_claim.hpp"

#include <array>
#include <atomic>

namespace haptoflow::unity {
namespace {

// For each place, the claim that holds it (0 for none) in the upper half and its use count in the lower half.
using Holder = std::atomic<std::uint64_t>;
static_assert(Holder::is_always_lock_free);
constinit std::array<Holder, capi::VoiceTable::capacity> holders{};
constinit std::atomic<std::uint32_t> claimsMade{0};

constexpr std::uint64_t withUseCounted(std::uint64_t holder, std::uint32_t claim) {
    return (std::uint64_t{claim} << 32) | static_cast<std::uint32_t>(holder + 1);
}

constexpr std::uint32_t claimOf(std::uint64_t holder) {
    return static_cast<std::uint32_t>(holder >> 32);
}

}  // namespace

VoiceClaim::VoiceClaim() noexcept : self_(claimsMade.fetch_add(1) + 1) {}

bool VoiceClaim::hold(std::size_t place, std::uint32_t frames, double sampleRateHz) noexcept {
    if (place != place_) {
        giveBack();
        place_ = place;
        found_ = 0;
        unchangedFrames_ = 0;
    }
    std::uint64_t holder = holders[place].load();
    const std::uint32_t claim = claimOf(holder);
    if (claim != self_ && claim != 0) {
        unchangedFrames_ = holder == found_ ? unchangedFrames_ + frames : 0;
        found_ = holder;
        if (static_cast<double>(unchangedFrames_) < abandonedSeconds * sampleRateHz) {
            return false;
        }
    }
    unchangedFrames_ = 0;
    return holders[place].compare_exchange_strong(holder, withUseCounted(holder, self_));
}

void VoiceClaim::giveBack() noexcept {
    if (place_ == nowhere) {
        return;
    }
    std::uint64_t holder = holders[place_].load();
    if (claimOf(holder) == self_) {
        holders[place_].compare_exchange_strong(holder, static_cast<std::uint32_t>(holder));
    }
    place_ = nowhere;
}

}  // namespace haptoflow::unity
