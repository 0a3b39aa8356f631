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

    /// Every sample another number, so that any that moved or changed shows.
    [[nodiscard]] static Sound pattern(std::size_t frameCount, std::size_t channelCount);
    [[nodiscard]] std::vector<float> channel(std::size_t index) const;
    void append(const Sound& more);

    std::size_t frames;
    std::size_t channels;
    std::vector<float> samples;
};

/// The definitions of a library that was loaded the way Unity loads it.
class UnityHost {
public:
    static constexpr const char* libraryPath = HAPTOFLOW_TEST_PLUGIN;

    /// Opens the library and asks its entry, which is looked up by name. Throws std::runtime_error.
    UnityHost();

    [[nodiscard]] std::span<AudioEffectDefinition* const> definitions() const { return definitions_; }
    /// Throws std::runtime_error where the library has no effect of that name.
    [[nodiscard]] const AudioEffectDefinition& effect(const std::string& name) const;

private:
    std::shared_ptr<const haptoflow::testing::DynamicLibrary> library_;
    std::span<AudioEffectDefinition*> definitions_;
};

/// An effect in a mixer group: made and released, called block by block, its state kept, its samples counted.
class HostedEffect {
public:
    explicit HostedEffect(const AudioEffectDefinition& definition, std::uint32_t sampleRateHz = 48000);
    HostedEffect(const HostedEffect&) = delete;
    HostedEffect& operator=(const HostedEffect&) = delete;
    ~HostedEffect();

    /// What the group plays for such an input. The samples behind the output's end are checked to be untouched.
    Sound process(const Sound& in, std::size_t outChannels);
    /// The same with one buffer for both.
    Sound processInPlace(const Sound& in, std::size_t outChannels);
    /// One block of silence in.
    Sound process(std::size_t frames, std::size_t channels = 2) { return process(Sound(frames, channels), channels); }
    /// Time goes on and nobody calls, as for a group that Unity suspends.
    void suspend(std::size_t frames) { state_.currentTick += frames; }

    /// The callback's result.
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
