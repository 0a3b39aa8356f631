#include "unity/voice_effect.hpp"

#include "haptoflow/haptoflow.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

namespace haptoflow::unity {
namespace {

enum Index : std::size_t { strengthIndex, voiceIndex, channelIndex };

constexpr float highestChannel = 7.0F;

// Not const, because Unity's interface takes a pointer to non-const.
constinit std::array<AudioParameterDefinition, VoiceParameters::parameterCount> parameterDefinitions{{
    {.name = {"Strength"},
     .unit = {"%"},
     .description = "Gain on the voice. Changes take 10 ms. The gain is applied after the voice's own strength and "
                    "limiter, so it can only weaken a vibration.",
     .minimum = 0.0F,
     .maximum = 1.0F,
     .defaultValue = 1.0F,
     .displayScale = 100.0F,
     .displayExponent = 1.0F},
    {.name = {"Voice"},
     .unit = {"place"},
     .description = "Selects the stylus: the place of its voice among the open voices, counted from 0. With one stylus "
                    "it is 0. If no voice is open at that place, the channel is silent.",
     .minimum = 0.0F,
     .maximum = static_cast<float>(HAPTOFLOW_MAXIMUM_VOICES - 1),
     .defaultValue = 0.0F,
     .displayScale = 1.0F,
     .displayExponent = 1.0F},
    {.name = {"Channel"},
     .unit = {"index"},
     .description = "Output channel that the voice overwrites: the one wired to the actuator's amplifier. 0 is left, 1 "
                    "is right, -1 is all channels. Other channels pass through unchanged. A channel that the output "
                    "lacks plays nothing.",
     .minimum = static_cast<float>(HAPTOFLOW_ALL_CHANNELS),
     .maximum = highestChannel,
     .defaultValue = static_cast<float>(HAPTOFLOW_ALL_CHANNELS),
     .displayScale = 1.0F,
     .displayExponent = 1.0F},
}};

/// Writes `prefix`, a whole number and `suffix`, truncated to the size of the text. printf depends on the locale and
/// may lock.
void writeText(char* text, std::string_view prefix, long number, std::string_view suffix) noexcept {
    char* const end = text + VoiceParameters::textSize - 1;
    text = std::copy(prefix.begin(), prefix.end(), text);
    text = std::to_chars(text, end, number).ptr;
    const auto room = std::min(suffix.size(), static_cast<std::size_t>(end - text));
    *std::copy_n(suffix.begin(), room, text) = '\0';
}

}  // namespace

VoiceParameters::VoiceParameters() noexcept {
    for (std::size_t i = 0; i < parameterCount; ++i) {
        values_[i].store(parameterDefinitions[i].defaultValue, std::memory_order_relaxed);
    }
}

std::span<AudioParameterDefinition> VoiceParameters::definitions() noexcept {
    return parameterDefinitions;
}

bool VoiceParameters::set(int index, float value) noexcept {
    if (index < 0 || index >= static_cast<int>(parameterCount) || std::isnan(value)) {
        return false;
    }
    const auto i = static_cast<std::size_t>(index);
    const float limited = std::clamp(value, parameterDefinitions[i].minimum, parameterDefinitions[i].maximum);
    values_[i].store(i == strengthIndex ? limited : std::round(limited), std::memory_order_relaxed);
    return true;
}

bool VoiceParameters::get(int index, float* value, char* text) const noexcept {
    if (index < 0 || index >= static_cast<int>(parameterCount)) {
        return false;
    }
    const auto i = static_cast<std::size_t>(index);
    const float found = values_[i].load(std::memory_order_relaxed);
    if (value != nullptr) {
        *value = found;
    }
    if (text == nullptr) {
        return true;
    }
    if (i == strengthIndex) {
        writeText(text, "", std::lround(found * 100.0F), " %");
    } else if (i == voiceIndex) {
        writeText(text, "voice ", std::lround(found), "");
    } else if (found == static_cast<float>(HAPTOFLOW_ALL_CHANNELS)) {
        *std::ranges::copy(std::string_view("all channels"), text).out = '\0';
    } else {
        writeText(text, "channel ", std::lround(found), "");
    }
    return true;
}

float VoiceParameters::strength() const noexcept {
    return values_[strengthIndex].load(std::memory_order_relaxed);
}

Route VoiceParameters::route() const noexcept {
    return {static_cast<std::size_t>(values_[voiceIndex].load(std::memory_order_relaxed)),
            static_cast<std::int32_t>(values_[channelIndex].load(std::memory_order_relaxed))};
}

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
    target.forEachFrame(0, target.frameCount, [this](std::size_t, std::span<float> samples) {
        const float gain = gain_.next();
        std::ranges::for_each(samples, [gain](float& sample) { sample *= gain; });
    });
}

}  // namespace haptoflow::unity
