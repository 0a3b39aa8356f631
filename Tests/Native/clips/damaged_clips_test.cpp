#include "clips/clip_formats.hpp"
#include "clips/clip_making.hpp"
#include "clips/clip_signals.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace haptoflow::clips {
namespace {

using ::testing::HasSubstr;

std::string messageOf(const std::string& text) {
    try {
        (void)readClip(text);
    } catch (const ClipError& error) {
        return error.what();
    }
    return {};
}

std::string haptic(const std::string& amplitude, const std::string& frequency = "[]") {
    return R"({"version":{"major":1,"minor":0,"patch":0},"signals":{"continuous":{"envelopes":{"amplitude":)" +
           amplitude + R"(,"frequency":)" + frequency + "}}}}";
}

struct Refusal {
    const char* name;
    std::string text;
    std::string says;
};

class DamagedClip : public ::testing::TestWithParam<Refusal> {};

TEST_P(DamagedClip, IsRefusedWithASentenceThatNamesThePlace) {
    EXPECT_THAT(messageOf(GetParam().text), HasSubstr(GetParam().says));
}

INSTANTIATE_TEST_SUITE_P(
    Refusals, DamagedClip,
    ::testing::Values(
        Refusal{"NoJson", "RIFF", "not valid JSON"}, Refusal{"NoClip", "{}", "none of the keys"},
        Refusal{"NoObject", "[1]", "none of the keys"},
        Refusal{"NewerVersion", R"({"version":{"major":2},"signals":{}})", "\"version.major\": expected 1"},
        Refusal{"NoAmplitude", haptic("[]"), "envelopes.amplitude\": expected at least 1"},
        Refusal{"TimeRunsBack", haptic(R"([{"time":1,"amplitude":0},{"time":0.5,"amplitude":0}])"),
                "amplitude[1].time\": expected a time that is not before"},
        Refusal{"AmplitudeAboveOne", haptic(R"([{"time":0,"amplitude":1.5}])"), "amplitude[0].amplitude"},
        Refusal{"FrequencyBelowZero", haptic(R"([{"time":0,"amplitude":0}])", R"([{"time":0,"frequency":-1}])"),
                "frequency[0].frequency"},
        Refusal{"WeakEmphasis", haptic(R"([{"time":0,"amplitude":0.5,"emphasis":{"amplitude":0.1,"frequency":0}}])"),
                "expected at least the amplitude of its point"},
        Refusal{"EndlessClip", haptic(R"([{"time":0,"amplitude":0},{"time":9999,"amplitude":0}])"), "lasts 9999 s"},
        Refusal{"UnknownEvent", R"({"Pattern":[{"Event":{"EventType":"Hum","Time":0}}]})", "HapticContinuous"},
        Refusal{"EventWithoutTime", R"({"Pattern":[{"Event":{"EventType":"HapticTransient"}}]})",
                "expected a member \"Time\""},
        Refusal{"EndlessEvent",
                R"({"Pattern":[{"Event":{"EventType":"HapticContinuous","Time":0,"EventDuration":700}}]})",
                "ends after 700 s"},
        Refusal{"WaveletsAlone",
                R"({"perceptions":[{"perception_modality":"Vibrotactile","effect_library":[],"channels":[{"gain":1,
                "bands":[{"band_type":"WaveletWave","effects":[]}]}]}]})",
                "nothing but 1 wavelet bands"},
        Refusal{"ReferenceToNothing",
                R"({"perceptions":[{"perception_modality":"Vibrotactile","effect_library":[],"channels":[{"gain":1,
                "bands":[{"band_type":"VectorialWave","effects":[{"effect_type":"Reference","id":3}]}]}]}]})",
                "the id of an effect of the library"}),
    [](const auto& each) { return each.param.name; });

/// A list of a text, so many times.
std::string repeated(const std::string& text, int times) {
    std::string list;
    for (int i = 0; i < times; ++i) {
        list += (i > 0 ? "," : "") + text;
    }
    return list;
}

TEST(CrowdedClip, IsRefusedBeforeItTakesLong) {
    const std::string longEvent =
        R"({"Event":{"EventType":"HapticContinuous","Time":0,"EventDuration":600,"EventParameters":[]}})";
    const std::string curve =
        R"({"ParameterCurve":{"ParameterID":"HapticIntensityControl","Time":0,"ParameterCurveControlPoints":[
        {"Time":0,"ParameterValue":0},{"Time":600,"ParameterValue":1}]}})";
    EXPECT_THAT(messageOf(R"({"Pattern":[)" + curve + ',' + repeated(longEvent, 20) + "]}"),
                HasSubstr("too many events"));
    const std::string tap = R"({"Event":{"EventType":"HapticTransient","Time":1}})";
    EXPECT_THAT(messageOf(R"({"Pattern":[)" + repeated(tap, 30'000) + "]}"), HasSubstr("more than 20000 transients"));
    std::string effects;
    for (int i = 0; i < 8'000; ++i) {
        effects += (i > 0 ? "," : "") + (R"({"effect_type":"Basis","position":)" + std::to_string(i)) +
                   R"(,"keyframes":[{"relative_position":0,"amplitude_modulation":1},{"relative_position":30000,)"
                   R"("amplitude_modulation":0}]})";
    }
    EXPECT_THAT(
        messageOf(R"({"perceptions":[{"perception_modality":"Vibrotactile","effect_library":[],"channels":[{"gain":1,)"
                  R"("bands":[{"band_type":"VectorialWave","effects":[)" +
                  effects + "]}]}]}]}"),
        HasSubstr("at the same time"));
}

class EveryDamagedFormat : public ::testing::TestWithParam<ClipFormat> {
protected:
    EveryDamagedFormat() {
        std::vector<float> wave = noise(2.0, 0.2);
        addTap(wave, 0.1, 40.0);
        text = writeClip(clipOf(wave), {.format = GetParam()}).text;
    }

    std::string text;
};

INSTANTIATE_TEST_SUITE_P(Formats, EveryDamagedFormat,
                         ::testing::Values(ClipFormat::haptic, ClipFormat::ahap, ClipFormat::hjif),
                         [](const auto& each) { return std::string(endingOf(each.param)); });

TEST_P(EveryDamagedFormat, CutAnywhereItIsRefused) {
    // The last two letters are the closing brace and the line feed.
    for (std::size_t length = 0; length + 2 < text.size(); length += 1 + length / 40) {
        EXPECT_FALSE(messageOf(text.substr(0, length)).empty()) << length;
    }
}

TEST_P(EveryDamagedFormat, WithAnyLettersExchangedItIsReadToAClipWithinItsBoundsOrRefused) {
    std::mt19937 engine(11);
    std::size_t read = 0;
    for (int round = 0; round < 4000; ++round) {
        std::string damaged = text;
        for (int i = 0; i < 1 + round % 4; ++i) {
            constexpr std::string_view letters = "0123456789.-eE[]{},\":nulx ";
            damaged[engine() % damaged.size()] = letters[engine() % letters.size()];
        }
        try {
            const HapticClip clip = readClip(damaged).clip;
            ++read;
            EXPECT_LE(clip.durationSeconds, HapticClip::longestSeconds);
            for (const ClipPoint& point : clip.amplitude) {
                ASSERT_TRUE(point.value >= 0.0 && point.value <= 1.0) << damaged;
            }
            if (clip.durationSeconds < 10.0) {
                for (const float sample : playedWave(clip, 2000.0)) {
                    ASSERT_TRUE(std::isfinite(sample));
                }
            }
        } catch (const ClipError&) {
        }
    }
    // Digits exchanged for digits are another clip.
    EXPECT_GT(read, 100U);
}

}  // namespace
}  // namespace haptoflow::clips
