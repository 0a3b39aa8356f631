#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(_WIN32)
#define HAPTOFLOW_UNITY_CALLBACK __stdcall
#else
#define HAPTOFLOW_UNITY_CALLBACK
#endif

/// Binary interface of Unity's Native Audio Plugin SDK, version 1.4.2, between Unity and an audio effect. The layout is
/// Unity's; the names are this project's.
namespace haptoflow::unity {

inline constexpr std::uint32_t audioPluginApiVersion = 0x010402;

/// Return values of the callbacks.
inline constexpr int resultOk = 0;
inline constexpr int resultUnsupported = 1;

/// Bits of AudioEffectState::flags. `playing` is also set while Unity is paused; only the editor sets `muted`.
inline constexpr std::uint32_t flagPlaying = 1;
inline constexpr std::uint32_t flagPaused = 2;
inline constexpr std::uint32_t flagMuted = 4;

/// State of an effect instance, allocated by Unity; 80 bytes or more. Older hosts lack the fields after `internal`,
/// which `structSize` shows.
struct AudioEffectState {
    std::uint32_t structSize;
    std::uint32_t sampleRateHz;
    /// Sample count at the start of the present block.
    std::uint64_t currentTick;
    std::uint64_t previousTick;
    float* sideChainBuffer;
    /// Belongs to the effect.
    void* effectData;
    std::uint32_t flags;
    void* internal;

    void* spatializerData;
    std::uint32_t dspBufferSize;
    std::uint32_t hostApiVersion;
    void* ambisonicData;
};

struct AudioParameterDefinition {
    std::array<char, 16> name;
    std::array<char, 16> unit;
    const char* description;
    float minimum;
    float maximum;
    float defaultValue;
    /// For display only: 100 shows a share in per cent.
    float displayScale;
    float displayExponent;
};

using StateCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state);
using ProcessCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state, float* in, float* out,
                                                       std::uint32_t frames, int inChannels, int outChannels);
using SetPositionCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state, std::uint32_t position);
using SetParameterCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state, int index, float value);
using GetParameterCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state, int index, float* value,
                                                            char* text);
using GetBufferCallback = int(HAPTOFLOW_UNITY_CALLBACK*)(AudioEffectState* state, const char* name, float* samples,
                                                         int count);

struct AudioEffectDefinition {
    std::uint32_t structSize;
    std::uint32_t parameterStructSize;
    std::uint32_t apiVersion;
    std::uint32_t pluginVersion;
    /// 0 for an effect, which accepts any number of channels.
    std::uint32_t channels;
    std::uint32_t parameterCount;
    std::uint64_t flags;
    std::array<char, 32> name;
    StateCallback create;
    StateCallback release;
    StateCallback reset;
    ProcessCallback process;
    SetPositionCallback setPosition;
    AudioParameterDefinition* parameters;
    SetParameterCallback setParameter;
    GetParameterCallback getParameter;
    GetBufferCallback getBuffer;
};

static_assert(sizeof(void*) != 8 ||
              (sizeof(AudioEffectState) == 80 && offsetof(AudioEffectState, effectData) == 32 &&
               offsetof(AudioEffectState, flags) == 40 && offsetof(AudioEffectState, internal) == 48 &&
               offsetof(AudioEffectState, ambisonicData) == 72));
static_assert(sizeof(void*) != 8 ||
              (sizeof(AudioParameterDefinition) == 64 && offsetof(AudioParameterDefinition, description) == 32 &&
               offsetof(AudioParameterDefinition, minimum) == 40));
static_assert(sizeof(void*) != 8 ||
              (sizeof(AudioEffectDefinition) == 136 && offsetof(AudioEffectDefinition, flags) == 24 &&
               offsetof(AudioEffectDefinition, name) == 32 && offsetof(AudioEffectDefinition, create) == 64 &&
               offsetof(AudioEffectDefinition, parameters) == 104));

}  // namespace haptoflow::unity
