#include "unity_host.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <span>

namespace haptoflow::unity::testing {
namespace {

using ::testing::AnyOf;
using ::testing::StartsWith;

bool endsWithin(std::span<const char> field) {
    return field.front() != '\0' && std::ranges::find(field, '\0') != field.end();
}

TEST(DefinitionTest, TheLibrarysFileNameHasThePrefixThatUnityLoads) {
    EXPECT_THAT(std::filesystem::path(UnityHost::libraryPath).filename().string(),
                AnyOf(StartsWith("audioplugin_haptoflow."), StartsWith("libaudioplugin_haptoflow.")));
}

TEST(DefinitionTest, TheLibraryDefinesOneEffect) {
    const UnityHost host;
    ASSERT_EQ(host.definitions().size(), 1U);
    EXPECT_STREQ(host.definitions()[0]->name.data(), "HaptoFlow Voice");
}

TEST(DefinitionTest, TheDefinitionStatesItsLayout) {
    const UnityHost host;
    const AudioEffectDefinition& definition = *host.definitions()[0];
    EXPECT_EQ(definition.structSize, 136U);
    EXPECT_EQ(definition.parameterStructSize, 64U);
    EXPECT_EQ(definition.apiVersion, 0x010402U);
    EXPECT_EQ(definition.pluginVersion, HAPTOFLOW_TEST_VERSION_MAJOR * 0x10000U +
                                            HAPTOFLOW_TEST_VERSION_MINOR * 0x100U + HAPTOFLOW_TEST_VERSION_PATCH);
    EXPECT_EQ(definition.channels, 0U) << "with a number of channels, it would be a generator";
    EXPECT_EQ(definition.flags, 0U);
}

TEST(DefinitionTest, EveryTextFitsItsField) {
    const UnityHost host;
    const AudioEffectDefinition& definition = *host.definitions()[0];
    EXPECT_TRUE(endsWithin(definition.name));
    ASSERT_EQ(definition.parameterCount, 3U);
    for (std::uint32_t i = 0; i < definition.parameterCount; ++i) {
        EXPECT_TRUE(endsWithin(definition.parameters[i].name)) << i;
        EXPECT_TRUE(endsWithin(definition.parameters[i].unit)) << i;
        ASSERT_NE(definition.parameters[i].description, nullptr) << i;
        EXPECT_GT(std::strlen(definition.parameters[i].description), 60U) << i;
    }
}

TEST(DefinitionTest, EveryParametersRangeContainsItsDefault) {
    const UnityHost host;
    const AudioEffectDefinition& definition = *host.definitions()[0];
    for (std::uint32_t i = 0; i < definition.parameterCount; ++i) {
        const AudioParameterDefinition& parameter = definition.parameters[i];
        EXPECT_LT(parameter.minimum, parameter.maximum) << parameter.name.data();
        EXPECT_LE(parameter.minimum, parameter.defaultValue) << parameter.name.data();
        EXPECT_GE(parameter.maximum, parameter.defaultValue) << parameter.name.data();
        EXPECT_GT(parameter.displayScale, 0.0F) << parameter.name.data();
        EXPECT_GT(parameter.displayExponent, 0.0F) << parameter.name.data();
    }
}

TEST(DefinitionTest, ANewEffectHasEachParametersDefault) {
    const UnityHost host;
    HostedEffect effect(*host.definitions()[0]);
    for (std::uint32_t i = 0; i < effect.definition().parameterCount; ++i) {
        const AudioParameterDefinition& parameter = effect.definition().parameters[i];
        EXPECT_EQ(effect.get(parameter.name.data()), parameter.defaultValue) << parameter.name.data();
    }
}

TEST(DefinitionTest, NullPointersAreRejected) {
    const UnityHost host;
    const AudioEffectDefinition& effect = *host.definitions()[0];
    AudioEffectState empty{};
    empty.structSize = sizeof(empty);
    for (AudioEffectState* state : {static_cast<AudioEffectState*>(nullptr), &empty}) {
        EXPECT_EQ(effect.release(state), resultUnsupported);
        EXPECT_EQ(effect.reset(state), resultUnsupported);
        EXPECT_EQ(effect.process(state, nullptr, nullptr, 64, 2, 2), resultUnsupported);
        EXPECT_EQ(effect.process(state, nullptr, nullptr, 0, 2, 2), resultOk);
        EXPECT_EQ(effect.setPosition(state, 0), resultUnsupported);
        EXPECT_EQ(effect.setParameter(state, 0, 0.5F), resultUnsupported);
        EXPECT_EQ(effect.getParameter(state, 0, nullptr, nullptr), resultUnsupported);
        EXPECT_EQ(effect.getBuffer(state, nullptr, nullptr, 1), resultUnsupported);
    }
    EXPECT_EQ(effect.create(nullptr), resultUnsupported);
}

TEST(DefinitionTest, WithoutAnEffectInstanceTheInputPassesThrough) {
    const UnityHost host;
    AudioEffectState empty{};
    empty.structSize = sizeof(empty);
    Sound in = Sound::pattern(8, 2);
    Sound out(8, 2);
    EXPECT_EQ(host.definitions()[0]->process(&empty, in.samples.data(), out.samples.data(), 8, 2, 2),
              resultUnsupported);
    EXPECT_EQ(out.samples, in.samples);
}

TEST(DefinitionTest, AnOlderHostsStateIsAcceptedAndATooShortStateIsRejected) {
    const UnityHost host;
    const AudioEffectDefinition& effect = *host.definitions()[0];
    // The host's own field and all fields after it are missing; the existing fields must not change.
    for (const std::uint32_t size : {56U, 80U, 200U}) {
        AudioEffectState state{};
        state.structSize = size;
        state.sampleRateHz = 48000;
        state.flags = flagPlaying;
        state.spatializerData = &state;
        state.dspBufferSize = 99;
        EXPECT_EQ(effect.create(&state), resultOk) << size;
        Sound sound = Sound::pattern(32, 2);
        EXPECT_EQ(effect.process(&state, sound.samples.data(), sound.samples.data(), 32, 2, 2), resultOk) << size;
        EXPECT_EQ(effect.release(&state), resultOk) << size;
        EXPECT_EQ(state.spatializerData, &state);
        EXPECT_EQ(state.dspBufferSize, 99U);
    }
    AudioEffectState state{};
    state.structSize = 40;
    EXPECT_EQ(effect.create(&state), resultUnsupported);
    EXPECT_EQ(state.effectData, nullptr);
}

class ParametersTest : public ::testing::Test {
protected:
    UnityHost host;
    HostedEffect effect{host.effect("HaptoFlow Voice")};
};

TEST_F(ParametersTest, AParameterKeepsItsValue) {
    EXPECT_EQ(effect.set("Strength", 0.25F), resultOk);
    EXPECT_EQ(effect.set("Voice", 63.0F), resultOk);
    EXPECT_EQ(effect.set("Channel", 7.0F), resultOk);
    EXPECT_EQ(effect.get("Strength"), 0.25F);
    EXPECT_EQ(effect.get("Voice"), 63.0F);
    EXPECT_EQ(effect.get("Channel"), 7.0F);
}

TEST_F(ParametersTest, ValuesOutOfRangeAreClamped) {
    const float infinity = std::numeric_limits<float>::infinity();
    struct Range {
        const char* name;
        float lowest;
        float highest;
    };
    for (const Range& parameter :
         {Range{"Strength", 0.0F, 1.0F}, Range{"Voice", 0.0F, 63.0F}, Range{"Channel", -1.0F, 7.0F}}) {
        for (const float high : {64.5F, 1e30F, infinity}) {
            EXPECT_EQ(effect.set(parameter.name, high), resultOk);
            EXPECT_EQ(effect.get(parameter.name), parameter.highest) << parameter.name << high;
        }
        for (const float low : {-1.5F, -1e30F, -infinity}) {
            EXPECT_EQ(effect.set(parameter.name, low), resultOk);
            EXPECT_EQ(effect.get(parameter.name), parameter.lowest) << parameter.name << low;
        }
    }
}

TEST_F(ParametersTest, NaNIsRejected) {
    for (const char* name : {"Strength", "Voice", "Channel"}) {
        EXPECT_EQ(effect.set(name, 1.0F), resultOk);
        EXPECT_EQ(effect.set(name, std::numeric_limits<float>::quiet_NaN()), resultUnsupported);
        EXPECT_EQ(effect.get(name), 1.0F) << name;
    }
}

TEST_F(ParametersTest, AnInvalidIndexIsRejected) {
    const AudioEffectDefinition& definition = effect.definition();
    for (const int index : {-1, 3, 1000, std::numeric_limits<int>::min(), std::numeric_limits<int>::max()}) {
        float value = 5.0F;
        EXPECT_EQ(definition.setParameter(&effect.state(), index, 0.0F), resultUnsupported) << index;
        EXPECT_EQ(definition.getParameter(&effect.state(), index, &value, nullptr), resultUnsupported) << index;
        EXPECT_EQ(value, 5.0F);
    }
}

TEST_F(ParametersTest, TheDisplayedTextDescribesTheValue) {
    effect.set("Strength", 0.754F);
    effect.set("Voice", 63.0F);
    effect.set("Channel", 3.0F);
    EXPECT_EQ(effect.text("Strength"), "75 %");
    EXPECT_EQ(effect.text("Voice"), "voice 63");
    EXPECT_EQ(effect.text("Channel"), "channel 3");
    effect.set("Channel", -1.0F);
    EXPECT_EQ(effect.text("Channel"), "all channels");
}

}  // namespace
}  // namespace haptoflow::unity::testing
