#include "unity_host.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace haptoflow::unity::testing {
namespace {

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
