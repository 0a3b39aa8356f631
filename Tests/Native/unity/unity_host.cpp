#include "unity_host.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

namespace haptoflow::unity::testing {
namespace {

// Samples after each output that detect writes past its end.
constexpr std::size_t guardSamples = 16;
constexpr float guard = 1234.5F;
constexpr float sideChainSample = 0.625F;

using GetDefinitions = int (*)(AudioEffectDefinition***);

}  // namespace

Sound Sound::pattern(std::size_t frameCount, std::size_t channelCount) {
    Sound sound(frameCount, channelCount);
    for (std::size_t i = 0; i < sound.samples.size(); ++i) {
        sound.samples[i] = 0.001F * static_cast<float>(i + 1);
    }
    return sound;
}

std::vector<float> Sound::channel(std::size_t index) const {
    std::vector<float> one(frames);
    for (std::size_t frame = 0; frame < frames; ++frame) {
        one[frame] = samples[frame * channels + index];
    }
    return one;
}

void Sound::append(const Sound& more) {
    frames += more.frames;
    samples.insert(samples.end(), more.samples.begin(), more.samples.end());
}

UnityHost::UnityHost() : library_(std::make_shared<haptoflow::testing::DynamicLibrary>(libraryPath)) {
    const auto entry = library_->function<GetDefinitions>("UnityGetAudioEffectDefinitions");
    AudioEffectDefinition** found = nullptr;
    const int count = entry(&found);
    definitions_ = {found, static_cast<std::size_t>(count)};
}

const AudioEffectDefinition& UnityHost::effect(const std::string& name) const {
    const auto found =
        std::ranges::find_if(definitions_, [&name](const auto* definition) { return definition->name.data() == name; });
    if (found == definitions_.end()) {
        throw std::runtime_error("no effect " + name);
    }
    return **found;
}

HostedEffect::HostedEffect(const AudioEffectDefinition& definition, std::uint32_t sampleRateHz)
    : definition_(definition), sideChain_(64, sideChainSample) {
    state_.structSize = sizeof(AudioEffectState);
    state_.sampleRateHz = sampleRateHz;
    state_.sideChainBuffer = sideChain_.data();
    state_.flags = flagPlaying;
    state_.internal = &state_;
    state_.hostApiVersion = audioPluginApiVersion;
    EXPECT_EQ(definition_.create(&state_), resultOk);
}

HostedEffect::~HostedEffect() {
    EXPECT_TRUE(std::ranges::all_of(sideChain_, [](float sample) { return sample == sideChainSample; }));
    EXPECT_EQ(definition_.release(&state_), resultOk);
    EXPECT_EQ(state_.effectData, nullptr);
}

Sound HostedEffect::process(const Sound& in, std::size_t outChannels) {
    std::vector<float> input = in.samples;
    // Unity does not clear its buffers.
    std::vector<float> output(in.frames * outChannels + guardSamples, guard);
    call(input.data(), output.data(), in.frames, in.channels, outChannels);
    EXPECT_EQ(input, in.samples) << "the effect changed the input";
    EXPECT_TRUE(std::all_of(output.end() - guardSamples, output.end(), [](float sample) { return sample == guard; }));
    Sound out(in.frames, outChannels);
    std::copy_n(output.begin(), out.samples.size(), out.samples.begin());
    return out;
}

Sound HostedEffect::processInPlace(const Sound& in, std::size_t outChannels) {
    std::vector<float> buffer(in.frames * std::max(in.channels, outChannels), guard);
    std::ranges::copy(in.samples, buffer.begin());
    call(buffer.data(), buffer.data(), in.frames, in.channels, outChannels);
    Sound out(in.frames, outChannels);
    std::copy_n(buffer.begin(), out.samples.size(), out.samples.begin());
    return out;
}

void HostedEffect::call(float* in, float* out, std::size_t frames, std::size_t inChannels, std::size_t outChannels) {
    EXPECT_EQ(definition_.process(&state_, in, out, static_cast<std::uint32_t>(frames), static_cast<int>(inChannels),
                                  static_cast<int>(outChannels)),
              resultOk);
    state_.previousTick = state_.currentTick;
    state_.currentTick += frames;
}

int HostedEffect::set(const char* parameter, float value) {
    return definition_.setParameter(&state_, indexOf(parameter), value);
}

float HostedEffect::get(const char* parameter) {
    float value = -1000.0F;
    EXPECT_EQ(definition_.getParameter(&state_, indexOf(parameter), &value, nullptr), resultOk);
    return value;
}

std::string HostedEffect::text(const char* parameter) {
    std::vector<char> text(64, '#');
    EXPECT_EQ(definition_.getParameter(&state_, indexOf(parameter), nullptr, text.data()), resultOk);
    const auto end = std::ranges::find(text, '\0');
    EXPECT_LT(end - text.begin(), 16) << "the text is longer than the buffer that FMOD guarantees";
    return {text.begin(), end};
}

int HostedEffect::indexOf(const char* parameter) const {
    for (std::uint32_t i = 0; i < definition_.parameterCount; ++i) {
        if (std::string(definition_.parameters[i].name.data()) == parameter) {
            return static_cast<int>(i);
        }
    }
    throw std::runtime_error(std::string("no parameter ") + parameter);
}

void HostedEffect::reset() {
    EXPECT_EQ(definition_.reset(&state_), resultOk);
}

}  // namespace haptoflow::unity::testing
