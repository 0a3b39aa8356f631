#pragma once

#include "support/dynamic_library.hpp"
#include "unity/audio_effect_sdk.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::unity::testing {

/// Interleaved frames.
struct Sound {
    Sound(std::size_t frameCount, std::size_t channelCount)
        : frames(frameCount), channels(channelCount), samples(frameCount * channelCount) {}

    /// All samples have different values, so that any moved or changed sample is detected.
    [[nodiscard]] static Sound pattern(std::size_t frameCount, std::size_t channelCount);
    [[nodiscard]] std::vector<float> channel(std::size_t index) const;
    void append(const Sound& more);

    std::size_t frames;
    std::size_t channels;
    std::vector<float> samples;
};

/// The effect definitions of a library that is loaded as Unity does.
class UnityHost {
public:
    static constexpr const char* libraryPath = HAPTOFLOW_TEST_PLUGIN;

    /// Opens the library and calls its entry function, which is looked up by name. Throws std::runtime_error.
    UnityHost();

    [[nodiscard]] std::span<AudioEffectDefinition* const> definitions() const { return definitions_; }
    /// Throws std::runtime_error if the library has no effect with that name.
    [[nodiscard]] const AudioEffectDefinition& effect(const std::string& name) const;

private:
    std::shared_ptr<const haptoflow::testing::DynamicLibrary> library_;
    std::span<AudioEffectDefinition*> definitions_;
};

/// An effect in a mixer group. Creates and releases the instance, keeps its state and counts its samples.
class HostedEffect {
public:
    explicit HostedEffect(const AudioEffectDefinition& definition, std::uint32_t sampleRateHz = 48000);
    HostedEffect(const HostedEffect&) = delete;
    HostedEffect& operator=(const HostedEffect&) = delete;
    ~HostedEffect();

    /// The output for `in`. Checks that the samples after the output's end are unchanged.
    Sound process(const Sound& in, std::size_t outChannels);
    /// Like `process`, with the same buffer for input and output.
    Sound processInPlace(const Sound& in, std::size_t outChannels);
    /// Processes one block of silence.
    Sound process(std::size_t frames, std::size_t channels = 2) { return process(Sound(frames, channels), channels); }
    /// Advances the time without a call, as for a suspended group.
    void suspend(std::size_t frames) { state_.currentTick += frames; }

    /// Returns the callback's result.
    int set(const char* parameter, float value);
    [[nodiscard]] float get(const char* parameter);
    [[nodiscard]] std::string text(const char* parameter);
    [[nodiscard]] int indexOf(const char* parameter) const;

    void reset();
    void setFlags(std::uint32_t flags) { state_.flags = flags; }
    void setSampleRate(std::uint32_t sampleRateHz) { state_.sampleRateHz = sampleRateHz; }
    [[nodiscard]] AudioEffectState& state() { return state_; }
    [[nodiscard]] const AudioEffectDefinition& definition() const { return definition_; }

private:
    void call(float* in, float* out, std::size_t frames, std::size_t inChannels, std::size_t outChannels);

    const AudioEffectDefinition& definition_;
    AudioEffectState state_{};
    std::vector<float> sideChain_;
};

}  // namespace haptoflow::unity::testing
