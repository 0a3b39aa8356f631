#include "unity/voice_effect.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstring>

namespace haptoflow::unity {
namespace {

void passFrame(const AudioBlock& block, std::size_t frame) noexcept {
    const std::size_t kept = std::min(block.inChannels, block.outChannels);
    float* out = block.out + frame * block.outChannels;
    std::memmove(out, block.in + frame * block.inChannels, kept * sizeof(float));
    std::fill(out + kept, out + block.outChannels, 0.0F);
}

}  // namespace

void passThrough(const AudioBlock& block) noexcept {
    const std::size_t frames = block.frames;
    if (block.in == nullptr || block.inChannels == 0) {
        std::fill_n(block.out, frames * block.outChannels, 0.0F);
    } else if (block.inChannels == block.outChannels) {
        if (block.in != block.out) {
            std::memmove(block.out, block.in, frames * block.outChannels * sizeof(float));
        }
    } else if (block.inChannels < block.outChannels) {
        // Start at the last frame: if the buffers are the same, the longer output frames overwrite later input.
        for (std::size_t frame = frames; frame > 0; --frame) {
            passFrame(block, frame - 1);
        }
    } else {
        for (std::size_t frame = 0; frame < frames; ++frame) {
            passFrame(block, frame);
        }
    }
}

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

namespace {

std::uint32_t framesIn(double seconds, double sampleRateHz) noexcept {
    return std::max(1U, static_cast<std::uint32_t>(seconds * sampleRateHz));
}

/// Writes zeros to the target's channels.
void silence(const capi::ChannelTarget& target, double sampleRateHz) noexcept {
    (void)capi::renderInto(capi::VoiceTable::Use{}, target, sampleRateHz);
}

}  // namespace

void VoiceEffect::process(const AudioBlock& block, const BlockContext& context) noexcept HAPTOFLOW_NONBLOCKING {
    passThrough(block);
    const Route newRoute = parameters_.route();
    const float strength = parameters_.strength();
    const bool hasGap = updateTick(context.tick, block.frames);
    if (startAnew_.exchange(false, std::memory_order_relaxed)) {
        route_ = newRoute;
        gain_.jumpTo(context.isSounding ? strength : 0.0F);
    } else if (hasGap) {
        gain_.jumpTo(0.0F);
    }

    std::uint32_t done = 0;
    if (!context.isSounding || newRoute != route_) {
        if (!gain_.isSettledAt(0.0F)) {
            done = std::min(block.frames, framesIn(stopSeconds, context.sampleRateHz));
            gain_.moveTo(0.0F, done);
            play(target(block, 0, done), context.sampleRateHz);
        }
        claim_.giveBack();
        route_ = newRoute;
    }
    if (done == block.frames) {
        return;
    }
    const capi::ChannelTarget rest = target(block, done, block.frames - done);
    if (!context.isSounding) {
        if (rest.isValid()) {
            silence(rest, context.sampleRateHz);
        }
        return;
    }
    if (gain_.target() != strength) {
        if (isVoiceSounding()) {
            gain_.moveTo(strength, framesIn(glideSeconds, context.sampleRateHz));
        } else {
            gain_.jumpTo(strength);
        }
    }
    play(rest, context.sampleRateHz);
}

bool VoiceEffect::updateTick(std::uint64_t tick, std::uint32_t frames) noexcept {
    // A gap counts only after consecutive blocks, so that a host that counts differently does not fade every block.
    const bool follows = tick == nextTick_;
    const bool hasGap = ticksFollow_ && !follows;
    ticksFollow_ = follows;
    nextTick_ = tick + frames;
    return hasGap;
}

bool VoiceEffect::isVoiceSounding() const noexcept {
    const capi::VoiceTable::Use voice = capi::voices().useAt(route_.place);
    return voice && voice->voice->channels.audible.load(std::memory_order_acquire);
}

capi::ChannelTarget VoiceEffect::target(const AudioBlock& block, std::uint32_t first,
                                        std::uint32_t count) const noexcept {
    return {block.out + std::size_t{first} * block.outChannels, count, block.outChannels, route_.channel};
}

void VoiceEffect::play(const capi::ChannelTarget& target, double sampleRateHz) noexcept {
    if (!target.isValid()) {
        claim_.giveBack();
        gain_.jumpTo(0.0F);
        return;
    }
    const capi::VoiceTable::Use voice = capi::voices().useAt(route_.place);
    if (voice && !claim_.hold(route_.place, target.frameCount, sampleRateHz)) {
        voice->refusedCalls.fetch_add(1, std::memory_order_relaxed);
        silence(target, sampleRateHz);
        gain_.jumpTo(0.0F);
        return;
    }
    // A voice that opens at an empty place needs no ramp, because it starts with silence.
    if (capi::renderInto(voice, target, sampleRateHz) == HAPTOFLOW_BUSY) {
        gain_.jumpTo(0.0F);
        return;
    }
    applyGain(target);
}

void VoiceEffect::applyGain(const capi::ChannelTarget& target) noexcept {
    if (gain_.isSettledAt(1.0F)) {
        return;
    }
    const bool isAll = target.channel == HAPTOFLOW_ALL_CHANNELS;
    const std::size_t width = isAll ? target.channelCount : 1;
    float* samples = target.interleaved + (isAll ? 0 : target.channel);
    for (std::uint32_t frame = 0; frame < target.frameCount; ++frame, samples += target.channelCount) {
        const float gain = gain_.next();
        std::for_each_n(samples, width, [gain](float& sample) { sample *= gain; });
    }
}

}  // namespace haptoflow::unity
