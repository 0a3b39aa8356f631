#include "effects/actuator_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace haptoflow::effects::actuator_profile_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string valid =
    R"({"format_version": 1, "name": "coil", "provenance": "a bench", "frequency_hz": [50, 100, 200],)"
    R"( "magnitude_db": [-10, 0, -3]})";

std::string with(const std::string& from, const std::string& to) {
    std::string text = valid;
    text.replace(text.find(from), from.size(), to);
    return text;
}

std::string refusalOf(const std::string& text) {
    try {
        (void)ActuatorProfile::parse(text);
    } catch (const ProfileError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(ActuatorProfileTest, EveryFieldIsReadAndWrittenAgain) {
    const ActuatorProfile profile = ActuatorProfile::parse(
        R"({"format_version": 1, "name": "coil", "provenance": "a bench", "approximate": true, "rated_level_mps2": 40,
            "frequency_hz": [50, 100, 200], "magnitude_db": [-10, 0, -3], "phase_degrees": [90, 0, -90],
            "resonances_hz": [100], "measurement": {"sample_rate_hz": 48000, "delay_seconds": 0.25,
            "distortion_percent": 1.5, "signal_to_noise_db": 60}})");
    for (const ActuatorProfile& each : {profile, ActuatorProfile::parse(profile.toJson())}) {
        EXPECT_EQ(each.name, "coil");
        EXPECT_EQ(each.provenance, "a bench");
        EXPECT_TRUE(each.isApproximate);
        EXPECT_EQ(each.ratedLevelMps2, 40.0);
        EXPECT_THAT(each.frequencyHz, ElementsAre(50.0, 100.0, 200.0));
        EXPECT_THAT(each.magnitudeDecibels, ElementsAre(-10.0, 0.0, -3.0));
        EXPECT_THAT(each.phaseDegrees, ElementsAre(90.0, 0.0, -90.0));
        EXPECT_THAT(each.resonancesHz, ElementsAre(100.0));
        ASSERT_TRUE(each.measurement.has_value());
        EXPECT_EQ(each.measurement->delaySeconds, 0.25);
        EXPECT_EQ(each.measurement->signalToNoiseDecibels, 60.0);
    }
}

TEST(ActuatorProfileTest, OptionalKeysMayBeMissing) {
    const ActuatorProfile profile = ActuatorProfile::parse(valid);
    EXPECT_FALSE(profile.isApproximate);
    EXPECT_FALSE(profile.ratedLevelMps2.has_value());
    EXPECT_TRUE(profile.phaseDegrees.empty());
    EXPECT_FALSE(profile.measurement.has_value());
    EXPECT_EQ(ActuatorProfile::parse(profile.toJson()).toJson(), profile.toJson());
}

TEST(ActuatorProfileTest, TheMagnitudeIsInterpolatedOverTheLogarithmOfFrequency) {
    const ActuatorProfile profile = ActuatorProfile::parse(valid);
    EXPECT_NEAR(profile.magnitudeDecibelsAt(std::sqrt(50.0 * 100.0)), -5.0, 1e-12);
    EXPECT_NEAR(profile.magnitudeDecibelsAt(200.0 / std::exp2(1.0 / 3.0)), -2.0, 1e-12);
    EXPECT_EQ(profile.magnitudeDecibelsAt(100.0), 0.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(1.0), -10.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(5000.0), -3.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(std::nan("")), -10.0);
}

TEST(ActuatorProfileTest, AnErrorNamesTheKeyAndTheExpectedValue) {
    EXPECT_THAT(refusalOf(with("-3]", "-300]")),
                AllOf(HasSubstr("key \"magnitude_db[2]\""), HasSubstr("from -200 to 200, found -300")));
    EXPECT_THAT(refusalOf(with("-3]", "\"loud\"]")), HasSubstr("found \"loud\""));
    EXPECT_THAT(refusalOf(with("-3]", "null]")), HasSubstr("key \"magnitude_db[2]\""));
    EXPECT_THAT(refusalOf(with("-10, 0, -3", "-10, 0")),
                AllOf(HasSubstr("key \"magnitude_db\""), HasSubstr("an array of 3 numbers, found an array of 2")));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50, 200, 100")),
                HasSubstr("key \"frequency_hz[2]\": expected a number above the one before"));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50, 50, 100")), HasSubstr("key \"frequency_hz[1]\""));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "0, 50, 100")), HasSubstr("key \"frequency_hz[0]\""));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50")), HasSubstr("at least 2 elements"));
    EXPECT_THAT(refusalOf(with("\"format_version\": 1", "\"format_version\": 2")), HasSubstr("update HaptoFlow"));
    EXPECT_THAT(refusalOf(with("\"name\": \"coil\", ", "")), HasSubstr("expected a member \"name\""));
    EXPECT_THAT(refusalOf(with("coil", "")), HasSubstr("key \"name\""));
    EXPECT_THAT(refusalOf(with("coil", "a\\nb")), HasSubstr("text without control characters"));
    EXPECT_THAT(refusalOf(with("\"name\"", "\"nam\"")), HasSubstr("expected no key \"nam\"; known are format_version"));
    EXPECT_THAT(refusalOf(with("}", ", \"phase_degrees\": [1]}")), HasSubstr("key \"phase_degrees\""));
    EXPECT_THAT(refusalOf(with("}", ", \"rated_level_mps2\": 0}")), HasSubstr("key \"rated_level_mps2\""));
    EXPECT_THAT(refusalOf(with("}", ", \"approximate\": 1}")), HasSubstr("true or false, found 1"));
    EXPECT_THAT(refusalOf(with("}", ", \"measurement\": {}}")), HasSubstr("expected a member \"sample_rate_hz\""));
}

TEST(ActuatorProfileTest, InvalidTextIsRejectedWithAOneLineMessage) {
    std::string manyPoints = R"({"format_version": 1, "name": "n", "provenance": "p", "frequency_hz": [1)";
    for (int point = 2; point < 6000; ++point) {
        manyPoints += "," + std::to_string(point);
    }
    const std::string deep(100000, '[');
    std::vector<std::string> texts{"",
                                   "null",
                                   "[]",
                                   "{",
                                   "NaN",
                                   deep,
                                   std::string(ActuatorProfile::maximumTextBytes + 1, ' '),
                                   manyPoints + "]}",
                                   with("-3", "NaN"),
                                   with("-3", "Infinity"),
                                   with("-3", "1e999"),
                                   with("-3", "1e308"),
                                   with("coil", "\xff\xfe"),
                                   with("coil", std::string(200, 'x')),
                                   with("\"name\"", "\"name\": \"one\", \"name\""),
                                   with("\"coil\"", "{\"a\": 1}"),
                                   with("[50, 100, 200]", "[[50], 100, 200]")};
    for (const std::string& text : texts) {
        const std::string refusal = refusalOf(text);
        EXPECT_NE(refusal, "not refused") << text.substr(0, 80);
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
        EXPECT_LT(refusal.size(), 400U) << refusal;
    }
}

TEST(ActuatorProfileTest, AProfileWithAChangedByteIsRejectedOrUsable) {
    std::mt19937 random(7);
    for (int round = 0; round < 4000; ++round) {
        std::string text = valid;
        for (unsigned change = 0; change <= random() % 3; ++change) {
            text[random() % text.size()] = static_cast<char>(random() % 256);
        }
        try {
            const ActuatorProfile profile = ActuatorProfile::parse(text);
            ASSERT_EQ(profile.frequencyHz.size(), profile.magnitudeDecibels.size()) << text;
            for (double hz = 1.0; hz < 1e4; hz *= 1.3) {
                ASSERT_TRUE(std::isfinite(profile.magnitudeDecibelsAt(hz))) << text;
            }
        } catch (const ProfileError&) {
        }
    }
}

TEST(ActuatorProfileTest, TheBuiltInProfilesAreFlatAndThePapersApproximateVoiceCoil) {
    for (const std::string_view name : {"flat", "voice-coil"}) {
        const auto profile = ActuatorProfile::builtIn(name);
        ASSERT_TRUE(profile.has_value()) << name;
        EXPECT_EQ(profile->name, name);
    }
    EXPECT_FALSE(ActuatorProfile::builtIn("voice coil").has_value());
    const ActuatorProfile flat = *ActuatorProfile::builtIn("flat");
    for (const double hz : {10.0, 50.0, 160.0, 1000.0, 5000.0}) {
        EXPECT_EQ(flat.magnitudeDecibelsAt(hz), 0.0);
    }
    const ActuatorProfile coil = *ActuatorProfile::builtIn("voice-coil");
    EXPECT_TRUE(coil.isApproximate);
    EXPECT_THAT(coil.resonancesHz, ElementsAre(160.0, 320.0));
    for (const double hz : {160.0, 320.0}) {
        for (const double factor : {0.8, 1.25}) {
            EXPECT_GT(coil.magnitudeDecibelsAt(hz), coil.magnitudeDecibelsAt(hz * factor) + 2.0) << hz * factor;
        }
    }
    for (double hz = 50.0; hz <= 100.0; hz *= 1.05) {
        EXPECT_LT(coil.magnitudeDecibelsAt(hz), -7.0) << hz;
    }
}

}  // namespace
}  // namespace haptoflow::effects::actuator_profile_test
