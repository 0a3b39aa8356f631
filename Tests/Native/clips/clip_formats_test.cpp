#include "clips/clip_formats.hpp"
#include "clips/clip_making.hpp"
#include "clips/clip_signals.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace haptoflow::clips {
namespace {

/// A texture that swells, with two taps and a rest.
HapticClip strokeClip() {
    std::vector<float> wave = noise(2.0, 3.0, 7);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double seconds = static_cast<double>(i) / testRateHz;
        const double swell = seconds > 2.2 ? 0.0 : 0.3 + std::abs(std::sin(3.0 * seconds));
        wave[i] *= static_cast<float>(swell);
    }
    addTap(wave, 0.7, 60.0);
    addTap(wave, 2.6, 15.0, 120.0);
    return clipOf(wave, {.origin = {.title = "wood",
                                    .description = "wood at 0.1 m/s and 1 N",
                                    .editor = "HaptoFlow",
                                    .author = "us",
                                    .source = "stroke.csv",
                                    .tags = {"wood", "texture"}}});
}

ReadClip roundTrip(const HapticClip& clip, ClipFormat format) {
    return readClip(writeClip(clip, {.format = format, .date = "2026-01-02"}).text);
}

class EveryFormat : public ::testing::TestWithParam<ClipFormat> {};

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat,
                         ::testing::Values(ClipFormat::haptic, ClipFormat::ahap, ClipFormat::hjif),
                         [](const auto& each) { return std::string(endingOf(each.param)); });

TEST_P(EveryFormat, ReadsBackWhatItWrote) {
    const HapticClip clip = strokeClip();
    const WrittenClip written = writeClip(clip, {.format = GetParam(), .pointsPerSecond = 250.0});
    const ReadClip read = readClip(written.text);
    EXPECT_EQ(read.format, GetParam());
    EXPECT_TRUE(read.omitted.empty());
    EXPECT_NEAR(read.clip.durationSeconds, clip.durationSeconds, 0.001);
    EXPECT_LE(written.amplitudeErrorDb, 0.56);
    EXPECT_LE(written.frequencyErrorPercent, 3.7);
    for (const ClipPoint& point : clip.amplitude) {
        const bool isNearTap = std::ranges::any_of(
            clip.transients, [&](const ClipTransient& tap) { return std::abs(tap.seconds - point.seconds) < 0.004; });
        if (!isNearTap) {
            const double played = std::max(0.02, valueAt(read.clip.amplitude, point.seconds, 0.0));
            EXPECT_NEAR(20.0 * std::log10(played / std::max(0.02, point.value)), 0.0, 0.8) << point.seconds;
        }
    }
    const double highestHz = GetParam() == ClipFormat::ahap ? sharpnessMaximumHz : hapticMaximumHz;
    const double lowestHz = GetParam() == ClipFormat::ahap ? sharpnessMinimumHz : hapticMinimumHz;
    for (const ClipPoint& point : clip.frequencyHz) {
        const double wanted = std::clamp(point.value, lowestHz, highestHz);
        EXPECT_NEAR(valueAt(read.clip.frequencyHz, point.seconds, 0.0) / wanted, 1.0, 0.06) << point.seconds;
    }
}

TEST_P(EveryFormat, TransientsKeepTimeAndAmplitude) {
    const HapticClip clip = strokeClip();
    ASSERT_GE(clip.transients.size(), 2U);
    const ReadClip read = roundTrip(clip, GetParam());
    ASSERT_EQ(read.clip.transients.size(), clip.transients.size());
    for (std::size_t i = 0; i < clip.transients.size(); ++i) {
        EXPECT_NEAR(read.clip.transients[i].seconds, clip.transients[i].seconds, 0.0006);
        EXPECT_NEAR(read.clip.transients[i].amplitude, clip.transients[i].amplitude, 0.01);
    }
}

TEST_P(EveryFormat, WhatIsWrittenAgainFromWhatWasReadPlaysTheSame) {
    const ReadClip once = roundTrip(strokeClip(), GetParam());
    const ReadClip twice = roundTrip(once.clip, GetParam());
    for (int step = 4; step < 225; ++step) {
        const double seconds = 0.0131 * step;
        EXPECT_NEAR(valueAt(twice.clip.amplitude, seconds, 0.0), valueAt(once.clip.amplitude, seconds, 0.0), 0.05);
    }
}

TEST_P(EveryFormat, HasNoMorePointsThanAllowedAndSaysTheError) {
    const WrittenClip few = writeClip(strokeClip(), {.format = GetParam(), .pointsPerSecond = 10.0});
    EXPECT_LE(few.amplitudePoints, 30U);
    EXPECT_LE(few.frequencyPoints, 30U);
    EXPECT_GT(few.amplitudeErrorDb, 1.0);
}

TEST_P(EveryFormat, ALoopEndsAsItBegins) {
    const HapticClip loop = clipOf(loopOf(noise(3.0, 5.0), 7000, 8000, 200), {.isLoop = true});
    const ReadClip read = roundTrip(loop, GetParam());
    EXPECT_NEAR(read.clip.amplitude.front().value, read.clip.amplitude.back().value, 1e-3);
    EXPECT_NEAR(read.clip.frequencyHz.front().value, read.clip.frequencyHz.back().value, 1.0);
}

TEST_P(EveryFormat, SaysWhereItComesFrom) {
    const ClipOrigin origin = roundTrip(strokeClip(), GetParam()).clip.origin;
    EXPECT_NE((origin.title + origin.description).find("wood at 0.1 m/s and 1 N"), std::string::npos);
}

TEST_P(EveryFormat, SilenceAndAClipOfOneFrameAreWritten) {
    for (const std::vector<float>& wave : {std::vector<float>(1), std::vector<float>(2000)}) {
        EXPECT_LT(roundTrip(clipOf(wave), GetParam()).clip.amplitude.front().value, 1e-3);
    }
}

TEST_P(EveryFormat, TwoTapsWithinAFewMillisecondsBothSurvive) {
    HapticClip clip{.durationSeconds = 0.5, .amplitude = {{0.0, 0.1}, {0.5, 0.1}}, .frequencyHz = {{0.0, 150.0}}};
    clip.transients = {{0.2, 0.9, 150.0}, {0.2021, 0.6, 150.0}, {0.2021, 0.5, 150.0}, {0.4995, 0.5, 150.0}};
    const ReadClip read = roundTrip(clip, GetParam());
    ASSERT_EQ(read.clip.transients.size(), 4U);
    EXPECT_NEAR(read.clip.transients[0].amplitude, 0.9, 0.01);
}

TEST(HapticFormatTest, EmphasisSitsAtAPointOfTheAmplitudeAndIsNotWeaker) {
    const auto document = nlohmann::json::parse(writeClip(strokeClip(), {.format = ClipFormat::haptic}).text);
    const auto& amplitude = document["signals"]["continuous"]["envelopes"]["amplitude"];
    double previous = 0.0;
    int emphases = 0;
    for (const auto& point : amplitude) {
        EXPECT_GE(point["time"].get<double>(), previous);
        previous = point["time"];
        if (point.contains("emphasis")) {
            ++emphases;
            EXPECT_GE(point["emphasis"]["amplitude"].get<double>(), point["amplitude"].get<double>());
        }
    }
    EXPECT_EQ(emphases, static_cast<int>(strokeClip().transients.size()));
    EXPECT_EQ(document["version"]["major"], 1);
}

TEST(AhapFormatTest, CurvesHaveSixteenPointsAtMostAndContinueEachOther) {
    const auto document = nlohmann::json::parse(writeClip(strokeClip(), {.format = ClipFormat::ahap}).text);
    for (const char* parameter : {"HapticIntensityControl", "HapticSharpnessControl"}) {
        int curves = 0;
        double end = 0.0;
        double value = -1.0;
        for (const auto& entry : document["Pattern"]) {
            if (!entry.contains("ParameterCurve") || entry["ParameterCurve"]["ParameterID"] != parameter) {
                continue;
            }
            const auto& curve = entry["ParameterCurve"];
            const auto& points = curve["ParameterCurveControlPoints"];
            EXPECT_LE(points.size(), 16U);
            EXPECT_EQ(points.front()["Time"], 0.0) << "times count from the curve's start";
            EXPECT_NEAR(curve["Time"].get<double>(), end, 1e-6);
            if (value >= 0.0) {
                EXPECT_EQ(points.front()["ParameterValue"].get<double>(), value);
            }
            end = curve["Time"].get<double>() + points.back()["Time"].get<double>();
            value = points.back()["ParameterValue"];
            ++curves;
        }
        EXPECT_GT(curves, 2) << parameter;
        EXPECT_NEAR(end, 3.0, 1e-6);
    }
}

TEST(AhapFormatTest, AContinuousEventLastsThirtySecondsAtMost) {
    const HapticClip clip{.durationSeconds = 70.0, .amplitude = {{0.0, 0.4}, {70.0, 0.4}}};
    const WrittenClip written = writeClip(clip, {.format = ClipFormat::ahap});
    int events = 0;
    const nlohmann::json document = nlohmann::json::parse(written.text);
    for (const auto& entry : document["Pattern"]) {
        if (entry.contains("Event")) {
            EXPECT_LE(entry["Event"]["EventDuration"].get<double>(), 30.0);
            ++events;
        }
    }
    EXPECT_EQ(events, 3);
    EXPECT_NEAR(readClip(written.text).clip.durationSeconds, 70.0, 1e-9);
}

TEST(AhapFormatTest, ATapInSilenceIsNotMultipliedAwayByTheIntensityCurve) {
    HapticClip clip{.durationSeconds = 1.0, .amplitude = {{0.0, 0.0}, {1.0, 0.0}}, .frequencyHz = {{0.0, 100.0}}};
    clip.transients = {{0.5, 0.64, 200.0}};
    const ReadClip read = roundTrip(clip, ClipFormat::ahap);
    ASSERT_EQ(read.clip.transients.size(), 1U);
    EXPECT_NEAR(read.clip.transients[0].amplitude, 0.64, 0.001);
    EXPECT_NEAR(read.clip.transients[0].frequencyHz, 200.0, 1.0);
    // The plateau that lets it through is over after 4 ms.
    EXPECT_EQ(valueAt(read.clip.amplitude, 0.495, 1.0), 0.0);
    EXPECT_EQ(valueAt(read.clip.amplitude, 0.505, 1.0), 0.0);
}

TEST(AhapFormatTest, ReadsWhatCoreHapticsAllows) {
    // Commas before brackets, missing parameters, values out of range, sound, and entries in any order.
    const ReadClip read = readClip(R"({"Version": 1.0, "Pattern": [
        {"Event": {"Time": 0.5, "EventType": "HapticTransient", "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 7}, {"ParameterID": "HapticSharpness", "ParameterValue": 1.0}, ]}},
        {"Event": {"Time": 0.1, "EventType": "AudioCustom", "EventWaveformPath": "a.wav"}},
        {"Event": {"Time": 0.0, "EventType": "HapticContinuous", "EventDuration": 0.4, "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 0.5},]}},
        {"Parameter": {"ParameterID": "HapticIntensityControl", "Time": 0.2, "ParameterValue": 0.5}},
    ]})");
    ASSERT_EQ(read.clip.transients.size(), 1U);
    EXPECT_NEAR(read.clip.transients[0].frequencyHz, 300.0, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.1, 0.0), 0.25, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.3, 0.0), 0.0625, 1e-9);
    EXPECT_EQ(read.omitted, std::vector<std::string>{"1 audio events"});
}

TEST(AhapFormatTest, CurvesWithTimesOfThePatternAreReadAsTheirToolMeansThem) {
    // Lofelt's converter writes them so; Apple counts from the curve's start.
    const char* lofelt = R"({"Version": 1, "Pattern": [
        {"ParameterCurve": {"ParameterID": "HapticIntensityControl", "Time": 2, "ParameterCurveControlPoints": [
            {"Time": 2, "ParameterValue": 0}, {"Time": 3, "ParameterValue": 1}]}},
        {"Event": {"Time": 0, "EventType": "HapticContinuous", "EventDuration": 4, "EventParameters": []}}]})";
    const char* apple = R"({"Version": 1, "Pattern": [
        {"ParameterCurve": {"ParameterID": "HapticIntensityControl", "Time": 2, "ParameterCurveControlPoints": [
            {"Time": 0, "ParameterValue": 0}, {"Time": 1, "ParameterValue": 1}]}},
        {"Event": {"Time": 0, "EventType": "HapticContinuous", "EventDuration": 4, "EventParameters": []}}]})";
    for (const char* text : {lofelt, apple}) {
        const ReadClip read = readClip(text);
        EXPECT_NEAR(valueAt(read.clip.amplitude, 1.9, 0.0), 1.0, 1e-9);
        EXPECT_NEAR(valueAt(read.clip.amplitude, 2.5, 0.0), 0.25, 1e-3);
        EXPECT_NEAR(valueAt(read.clip.amplitude, 3.5, 0.0), 1.0, 1e-9);
    }
}

TEST(AhapFormatTest, OfOverlappingEventsTheStrongerIsFelt) {
    const ReadClip read = readClip(R"({"Pattern": [
        {"Event": {"Time": 0, "EventType": "HapticContinuous", "EventDuration": 1, "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 0.5}, {"ParameterID": "HapticSharpness", "ParameterValue": 0}]}},
        {"Event": {"Time": 0.4, "EventType": "HapticContinuous", "EventDuration": 0.2, "EventParameters": [
            {"ParameterID": "HapticIntensity", "ParameterValue": 1}, {"ParameterID": "HapticSharpness", "ParameterValue": 1}]}}]})");
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.2, 0.0), 0.25, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.5, 0.0), 1.0, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.8, 0.0), 0.25, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.frequencyHz, 0.5, 0.0), 300.0, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.frequencyHz, 0.8, 0.0), 65.0, 1e-9);
}

TEST(HjifFormatTest, KeyframesOfOneKindNeverShareATick) {
    HapticClip clip{.durationSeconds = 1.0};
    for (int i = 0; i < 40; ++i) {
        clip.amplitude.push_back({0.5 + 1e-5 * i, 0.1 + 0.4 * (i % 2)});
    }
    clip.amplitude.push_back({1.0, 0.1});
    const auto document = nlohmann::json::parse(writeClip(clip, {.format = ClipFormat::hjif}).text);
    int previous = -1;
    for (const auto& keyframe : document["perceptions"][0]["channels"][0]["bands"][0]["effects"][0]["keyframes"]) {
        EXPECT_GT(keyframe["relative_position"].get<int>(), previous);
        previous = keyframe["relative_position"];
    }
}

TEST(HjifFormatTest, ReadsLibraryGainAndTimescale) {
    const ReadClip read = readClip(R"({"version": "2023", "profile": "Main", "level": 1, "date": "", "description": "d",
        "timescale": 8000, "avatars": [], "syncs": [], "perceptions": [{"id": 0, "avatar_id": 0, "description": "",
        "perception_modality": "Vibrotactile", "effect_library": [{"id": 5, "effect_type": "Basis", "phase": 0,
        "base_signal": "Sine", "keyframes": [{"relative_position": 0, "amplitude_modulation": 0.5, "frequency_modulation": 120},
        {"relative_position": 8000, "amplitude_modulation": -1.0}]}], "channels": [{"id": 0, "description": "", "gain": 0.5,
        "mixing_coefficient": 1, "bands": [{"band_type": "VectorialWave", "lower_frequency_limit": 0,
        "upper_frequency_limit": 500, "effects": [{"effect_type": "Reference", "id": 5, "position": 4000}]},
        {"band_type": "WaveletWave", "block_length": 512, "lower_frequency_limit": 0, "upper_frequency_limit": 500, "effects": []}
        ]}]}]})");
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.25, 1.0), 0.0, 1e-9);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 0.5001, 0.0), 0.25, 1e-3);
    EXPECT_NEAR(valueAt(read.clip.amplitude, 1.4999, 0.0), 0.5, 1e-3);
    EXPECT_NEAR(valueAt(read.clip.frequencyHz, 1.0, 0.0), 120.0, 1e-9);
    EXPECT_EQ(read.omitted, std::vector<std::string>{"1 wavelet bands"});
}

TEST(PlayedWaveTest, AMotorWithOneFrequencyPlaysTheAmplitudeAtIt) {
    const HapticClip clip{.durationSeconds = 1.0, .amplitude = {{0.0, 0.5}, {1.0, 0.5}}, .frequencyHz = {{0.0, 80.0}}};
    const std::vector<float> wave = playedWave(clip, 8000.0, 160.0, 160.0);
    int crossings = 0;
    for (std::size_t i = 1; i < wave.size(); ++i) {
        crossings += (wave[i] < 0.0F) != (wave[i - 1] < 0.0F) ? 1 : 0;
    }
    EXPECT_NEAR(crossings, 320, 2);
    EXPECT_NEAR(*std::ranges::max_element(wave), 0.5F, 1e-3F);
}

TEST(PlayedWaveTest, NeverLeavesTheRangeOfTheDevice) {
    HapticClip clip{.durationSeconds = 0.2, .amplitude = {{0.0, 1.0}, {0.2, 1.0}}};
    clip.transients = {{0.05, 1.0, 150.0}, {0.051, 1.0, 150.0}};
    for (const float sample : playedWave(clip, 48000.0)) {
        EXPECT_LE(std::abs(sample), 1.0F);
    }
}

}  // namespace
}  // namespace haptoflow::clips
