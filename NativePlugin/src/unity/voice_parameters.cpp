#include "unity/voice_parameters.hpp"

#include "haptoflow/haptoflow.h"

#include <algorithm>
#include <charconv>
#include <cmath>
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

}  // namespace haptoflow::unity
