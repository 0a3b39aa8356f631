#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(_WIN32)
#define HAPTOFLOW_UNITY_CALLBACK __stdcall
#else
#define HAPTOFLOW_UNITY_CALLBACK
#endif

/// What Unity's Native Audio Plugin SDK, version 1.4.2, lays down between the editor or player and an effect. The
/// layout is Unity's, the names are this project's.
namespace haptoflow::unity {

inline constexpr std::uint32_t audioPluginApiVersion = 0x010402;

/// What every callback returns.
inline constexpr int resultOk = 0;
inline constexpr int resultUnsupported = 1;

/// AudioEffectState::flags. `playing` is also set while Unity is paused; `muted` is only set by the editor.
inline constexpr std::uint32_t flagPlaying = 1;
inline constexpr std::uint32_t flagPaused = 2;
inline constexpr std::uint32_t flagMuted = 4;

/// Made by Unity, one for each instance of an effect; 80 bytes or more. Fields behind `internal` came later: no older
/// host has them, and `structSize` tells.
struct AudioEffectState {
    std::uint32_t structSize;
    std::uint32_t sampleRateHz;
    /// Counts samples; the first one of the present block.
    std::uint64_t currentTick;
    std::uint64_t previousTick;
    float* sideChainBuffer;
    /// The effect's own.
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
    /// For display only: 100 for a share that is shown in per cent.
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
    /// 0 for an effect, which takes whatever comes.
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
