#include "haptoflow/haptoflow.h"
#include "unity/audio_effect_sdk.hpp"
#include "unity/voice_effect.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <new>
#include <string_view>

namespace haptoflow::unity {
namespace {

// Size of the part of the state that is used here. Every version of Unity provides it.
constexpr std::size_t requiredStateSize = offsetof(AudioEffectState, internal);

constexpr std::uint32_t versionNumber(std::string_view version) {
    std::uint32_t number = 0;
    std::uint32_t part = 0;
    for (const char digit : version) {
        if (digit == '.') {
            number = (number | part) << 8;
            part = 0;
        } else {
            part = part * 10 + static_cast<std::uint32_t>(digit - '0');
        }
    }
    return number | part;
}

bool isUsable(const AudioEffectState* state) noexcept {
    return state != nullptr && state->structSize >= requiredStateSize;
}

VoiceEffect* effectOf(const AudioEffectState* state) noexcept {
    return isUsable(state) ? static_cast<VoiceEffect*>(state->effectData) : nullptr;
}

int resultOf(bool isDone) noexcept {
    return isDone ? resultOk : resultUnsupported;
}

int HAPTOFLOW_UNITY_CALLBACK create(AudioEffectState* state) {
    if (!isUsable(state)) {
        return resultUnsupported;
    }
    state->effectData = new (std::nothrow) VoiceEffect;
    return resultOf(state->effectData != nullptr);
}

int HAPTOFLOW_UNITY_CALLBACK release(AudioEffectState* state) {
    VoiceEffect* const effect = effectOf(state);
    if (effect == nullptr) {
        return resultUnsupported;
    }
    delete effect;
    state->effectData = nullptr;
    return resultOk;
}

int HAPTOFLOW_UNITY_CALLBACK reset(AudioEffectState* state) {
    VoiceEffect* const effect = effectOf(state);
    if (effect != nullptr) {
        effect->reset();
    }
    return resultOf(effect != nullptr);
}

int HAPTOFLOW_UNITY_CALLBACK process(AudioEffectState* state, float* in, float* out, std::uint32_t frames,
                                     int inChannels, int outChannels) {
    if (frames == 0 || outChannels <= 0) {
        return resultOf(frames == 0);
    }
    if (out == nullptr) {
        return resultUnsupported;
    }
    const AudioBlock block{in, out, frames, static_cast<std::uint32_t>(std::max(inChannels, 0)),
                           static_cast<std::uint32_t>(outChannels)};
    VoiceEffect* const effect = effectOf(state);
    if (effect == nullptr) {
        passThrough(block);
        return resultUnsupported;
    }
    const bool isSounding = (state->flags & (flagPlaying | flagPaused | flagMuted)) == flagPlaying;
    effect->process(block, {static_cast<double>(state->sampleRateHz), state->currentTick, isSounding});
    return resultOk;
}

int HAPTOFLOW_UNITY_CALLBACK setPosition(AudioEffectState*, std::uint32_t) {
    return resultUnsupported;
}

int HAPTOFLOW_UNITY_CALLBACK setParameter(AudioEffectState* state, int index, float value) {
    VoiceEffect* const effect = effectOf(state);
    return resultOf(effect != nullptr && effect->parameters().set(index, value));
}

int HAPTOFLOW_UNITY_CALLBACK getParameter(AudioEffectState* state, int index, float* value, char* text) {
    VoiceEffect* const effect = effectOf(state);
    return resultOf(effect != nullptr && effect->parameters().get(index, value, text));
}

int HAPTOFLOW_UNITY_CALLBACK getBuffer(AudioEffectState*, const char*, float*, int) {
    return resultUnsupported;
}

AudioEffectDefinition makeDefinition() noexcept {
    AudioEffectDefinition definition{};
    definition.structSize = sizeof(AudioEffectDefinition);
    definition.parameterStructSize = sizeof(AudioParameterDefinition);
    definition.apiVersion = audioPluginApiVersion;
    definition.pluginVersion = versionNumber(HAPTOFLOW_VERSION);
    definition.parameterCount = static_cast<std::uint32_t>(VoiceParameters::definitions().size());
    constexpr std::string_view name = "HaptoFlow Voice";
    static_assert(name.size() < sizeof(definition.name));
    std::ranges::copy(name, definition.name.begin());
    definition.create = create;
    definition.release = release;
    definition.reset = reset;
    definition.process = process;
    definition.setPosition = setPosition;
    definition.parameters = VoiceParameters::definitions().data();
    definition.setParameter = setParameter;
    definition.getParameter = getParameter;
    definition.getBuffer = getBuffer;
    return definition;
}

}  // namespace
}  // namespace haptoflow::unity

/// Unity calls this function after it has loaded the library, whose file name must begin with `audioplugin`. Sets
/// *definitions to the effects' definitions, which live as long as the library, and returns their number.
// NOLINTNEXTLINE(readability-identifier-naming): Unity looks the function up by this name.
extern "C" HAPTOFLOW_API int UnityGetAudioEffectDefinitions(haptoflow::unity::AudioEffectDefinition*** definitions);

// NOLINTNEXTLINE(readability-identifier-naming): Unity looks the function up by this name.
extern "C" HAPTOFLOW_API int UnityGetAudioEffectDefinitions(haptoflow::unity::AudioEffectDefinition*** definitions) {
    if (definitions == nullptr) {
        return 0;
    }
    static haptoflow::unity::AudioEffectDefinition definition = haptoflow::unity::makeDefinition();
    static std::array<haptoflow::unity::AudioEffectDefinition*, 1> all{&definition};
    *definitions = all.data();
    return static_cast<int>(all.size());
}
