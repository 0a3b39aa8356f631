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

TEST(LibraryTest, TheLibrarysFileNameHasThePrefixThatUnityLoads) {
    EXPECT_THAT(std::filesystem::path(UnityHost::libraryPath).filename().string(),
                AnyOf(StartsWith("audioplugin_haptoflow."), StartsWith("libaudioplugin_haptoflow.")));
}

/// The library's only effect.
class DefinitionTest : public ::testing::Test {
protected:
    UnityHost host_;
    const AudioEffectDefinition& definition_ = *host_.definitions()[0];
};

TEST_F(DefinitionTest, TheLibraryDefinesOneEffectAndStatesItsLayout) {
    ASSERT_EQ(host_.definitions().size(), 1U);
    EXPECT_STREQ(definition_.name.data(), "HaptoFlow Voice");
    EXPECT_EQ(definition_.structSize, 136U);
    EXPECT_EQ(definition_.parameterStructSize, 64U);
    EXPECT_EQ(definition_.apiVersion, 0x010402U);
    EXPECT_EQ(definition_.pluginVersion, HAPTOFLOW_TEST_VERSION_MAJOR * 0x10000U +
                                             HAPTOFLOW_TEST_VERSION_MINOR * 0x100U + HAPTOFLOW_TEST_VERSION_PATCH);
    EXPECT_EQ(definition_.channels, 0U) << "with a number of channels, it would be a generator";
    EXPECT_EQ(definition_.flags, 0U);
}

TEST_F(DefinitionTest, EveryParametersTextFitsItsFieldAndItsRangeContainsTheDefaultThatANewEffectHas) {
    HostedEffect effect(definition_);
    EXPECT_TRUE(endsWithin(definition_.name));
    ASSERT_EQ(definition_.parameterCount, 3U);
    for (std::uint32_t i = 0; i < definition_.parameterCount; ++i) {
        const AudioParameterDefinition& parameter = definition_.parameters[i];
        SCOPED_TRACE(i);
        EXPECT_TRUE(endsWithin(parameter.name));
        EXPECT_TRUE(endsWithin(parameter.unit));
        ASSERT_NE(parameter.description, nullptr);
        EXPECT_GT(std::strlen(parameter.description), 60U);
        EXPECT_LT(parameter.minimum, parameter.maximum);
        EXPECT_LE(parameter.minimum, parameter.defaultValue);
        EXPECT_GE(parameter.maximum, parameter.defaultValue);
        EXPECT_GT(parameter.displayScale, 0.0F);
        EXPECT_GT(parameter.displayExponent, 0.0F);
        EXPECT_EQ(effect.get(parameter.name.data()), parameter.defaultValue);
    }
}

TEST_F(DefinitionTest, NullPointersAreRejected) {
    AudioEffectState empty{};
    empty.structSize = sizeof(empty);
    for (AudioEffectState* state : {static_cast<AudioEffectState*>(nullptr), &empty}) {
        EXPECT_EQ(definition_.release(state), resultUnsupported);
        EXPECT_EQ(definition_.reset(state), resultUnsupported);
        EXPECT_EQ(definition_.process(state, nullptr, nullptr, 64, 2, 2), resultUnsupported);
        EXPECT_EQ(definition_.process(state, nullptr, nullptr, 0, 2, 2), resultOk);
        EXPECT_EQ(definition_.setPosition(state, 0), resultUnsupported);
        EXPECT_EQ(definition_.setParameter(state, 0, 0.5F), resultUnsupported);
        EXPECT_EQ(definition_.getParameter(state, 0, nullptr, nullptr), resultUnsupported);
        EXPECT_EQ(definition_.getBuffer(state, nullptr, nullptr, 1), resultUnsupported);
    }
    EXPECT_EQ(definition_.create(nullptr), resultUnsupported);
}

TEST_F(DefinitionTest, WithoutAnEffectInstanceTheInputPassesThrough) {
    AudioEffectState empty{};
    empty.structSize = sizeof(empty);
    Sound in = Sound::pattern(8, 2);
    Sound out(8, 2);
    EXPECT_EQ(definition_.process(&empty, in.samples.data(), out.samples.data(), 8, 2, 2), resultUnsupported);
    EXPECT_EQ(out.samples, in.samples);
}

TEST_F(DefinitionTest, AnOlderHostsStateIsAcceptedAndATooShortStateIsRejected) {
    // The host's own field and all fields after it are missing; the existing fields must not change.
    for (const std::uint32_t size : {56U, 80U, 200U}) {
        AudioEffectState state{};
        state.structSize = size;
        state.sampleRateHz = 48000;
        state.flags = flagPlaying;
        state.spatializerData = &state;
        state.dspBufferSize = 99;
        EXPECT_EQ(definition_.create(&state), resultOk) << size;
        Sound sound = Sound::pattern(32, 2);
        EXPECT_EQ(definition_.process(&state, sound.samples.data(), sound.samples.data(), 32, 2, 2), resultOk) << size;
        EXPECT_EQ(definition_.release(&state), resultOk) << size;
        EXPECT_EQ(state.spatializerData, &state);
        EXPECT_EQ(state.dspBufferSize, 99U);
    }
    AudioEffectState state{};
    state.structSize = 40;
    EXPECT_EQ(definition_.create(&state), resultUnsupported);
    EXPECT_EQ(state.effectData, nullptr);
}

class ParametersTest : public ::testing::Test {
protected:
    UnityHost host;
    HostedEffect effect{host.effect("HaptoFlow Voice")};
};

TEST_F(ParametersTest, ValuesOutOfRangeAreClampedAndNaNIsRejected) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    struct Range {
        const char* name;
        float lowest;
        float highest;
    };
    for (const auto& [name, lowest, highest] :
         {Range{"Strength", 0.0F, 1.0F}, Range{"Voice", 0.0F, 63.0F}, Range{"Channel", -1.0F, 7.0F}}) {
        for (const float high : {64.5F, 1e30F, infinity}) {
            EXPECT_EQ(effect.set(name, high), resultOk);
            EXPECT_EQ(effect.get(name), highest) << name << high;
        }
        for (const float low : {-1.5F, -1e30F, -infinity}) {
            EXPECT_EQ(effect.set(name, low), resultOk);
            EXPECT_EQ(effect.get(name), lowest) << name << low;
        }
        EXPECT_EQ(effect.set(name, std::numeric_limits<float>::quiet_NaN()), resultUnsupported);
        EXPECT_EQ(effect.get(name), lowest) << name;
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
