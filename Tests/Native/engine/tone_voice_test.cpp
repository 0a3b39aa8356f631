#include "engine/live_engine.hpp"
#include "engine/offline_renderer.hpp"
#include "model/material_builder.hpp"
#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

// Tone in the callback: the filter of a material and a surface on the generated waveform.

namespace haptoflow::engine {
namespace {

using effects::EffectKind;
using nlohmann::json;
using testing::FakeGenerator;
using testing::lifted;
using testing::SimulatedDevice;
using testing::sliding;

/// A material with a tone of `gainDb` at every frequency: from 1 N on, or at every force.
model::MaterialFile materialOf(const model::ModelFile& model, double gainDb, bool onlyFirm = false) {
    json text = model::testing::validMaterial(model::spaceOf(model.header()));
    text["tone"] = {{"speeds_mps", {0.1}}, {"frequencies_hz", {50.0, 500.0}}, {"gains_db", {{gainDb, gainDb}}}};
    if (onlyFirm) {
        text["tone"]["forces_newtons"] = {0.25, 1.0};
        text["tone"]["gains_db"] = {{0.0, 0.0}, {gainDb, gainDb}};
    }
    text["level"]["log_levels"] = {0.0, 0.0, 0.0};
    text["level"]["force_exponent"] = 0.0;
    text["level_exponents"] = {{"speed", 0.0}, {"force", 0.0}};
    text["level_offset_db"] = 0.0;
    return model::parseMaterial(text.dump());
}

double rms(std::span<const float> samples) {
    double squares = 0.0;
    for (const float sample : samples) {
        squares += static_cast<double>(sample) * static_cast<double>(sample);
    }
    return std::sqrt(squares / static_cast<double>(samples.size()));
}

class ToneVoiceTest : public ::testing::Test {
protected:
    SimulatedDevice device() { return SimulatedDevice(model_, generator_); }

    std::uint32_t registered(SimulatedDevice& on, double gainDb) {
        return static_cast<std::uint32_t>(
            on.library.add(materialOf(model_, gainDb), [this]() -> inference::LevelEstimator& { return generator_; }));
    }
    static const EffectCounters& toneOf(const SimulatedDevice& on) {
        return on.counters().effects[static_cast<std::size_t>(EffectKind::tone)];
    }
    static ContactState on(std::uint32_t label) {
        ContactState state = sliding();
        state.material.labels[0] = label;
        return state;
    }

    model::ModelFile model_ = testing::smallModel();
    FakeGenerator generator_{testing::continueTone};
};

TEST_F(ToneVoiceTest, WithoutAToneTheFilterDoesNotRun) {
    SimulatedDevice plain(model_, generator_);
    (void)registered(plain, 12.0);
    plain.run(1.0, [](double) { return on(0); });
    const EffectCounters& tone = toneOf(plain);
    EXPECT_EQ(tone.prepared + tone.runs + tone.samples + tone.nanoseconds + tone.events, 0U);
    EXPECT_EQ(plain.counters().requestedEffects & effects::maskOf(EffectKind::tone), 0U);
}

TEST_F(ToneVoiceTest, AMaterialsToneAppliesFromTheSeedsFirstSampleAndNotToTheTimeline) {
    SimulatedDevice plain(model_, generator_);
    SimulatedDevice toned(model_, generator_);
    const std::uint32_t soft = registered(plain, 0.0);
    const std::uint32_t loud = registered(toned, 12.0);
    plain.run(1.0, [soft](double) { return on(soft); });
    toned.run(1.0, [loud](double) { return on(loud); });
    ASSERT_EQ(plain.waveform.samples.size(), toned.waveform.samples.size());
    const float gain = std::pow(10.0F, 12.0F / 20.0F);
    for (std::size_t i = 0; i < plain.waveform.samples.size(); ++i) {
        ASSERT_NEAR(toned.waveform.samples[i], gain * plain.waveform.samples[i], 1e-3F) << i;
    }
    EXPECT_NEAR(rms(toned.output) / rms(plain.output), static_cast<double>(gain), 0.05);
    const EffectCounters& tone = toneOf(toned);
    EXPECT_EQ(tone.prepared, 1U);
    EXPECT_GT(tone.runs, 100U);
    EXPECT_GE(tone.samples, toned.waveform.samples.size());
    EXPECT_NE(toned.counters().requestedEffects & effects::maskOf(EffectKind::tone), 0U);
}

TEST_F(ToneVoiceTest, ATiltChangesTheGainAtTheSoundingFrequency) {
    SimulatedDevice plain(model_, generator_);
    SimulatedDevice dark(model_, generator_);
    plain.run(1.0, [](double) { return sliding(); });
    dark.run(1.0, [](double) {
        ContactState state = sliding();
        state.toneDbPerOctave = 6.0F;
        return state;
    });
    const double octaves = std::log2(testing::toneHz / 150.0);
    const std::span<const float> played(plain.waveform.samples);
    const std::span<const float> tilted(dark.waveform.samples);
    EXPECT_NEAR(20.0 * std::log10(rms(tilted.last(1000)) / rms(played.last(1000))), 6.0 * octaves, 0.5);
}

TEST_F(ToneVoiceTest, ANewTouchDoesNotUseTheToneOfTheTouchBefore) {
    SimulatedDevice once(model_, generator_);
    SimulatedDevice twice(model_, generator_);
    const std::uint32_t first = registered(once, 12.0);
    ASSERT_EQ(registered(twice, 12.0), first);
    const auto touch = [first](std::uint32_t counter, std::uint32_t label) {
        ContactState state = on(label);
        state.material.labels[0] = label == 99 ? first : label;
        state.touchCounter = counter;
        return state;
    };
    once.run(0.05, [&](double) { return touch(1, 99); });
    twice.run(0.5, [&](double) { return touch(1, 0); });
    twice.run(0.3, [](double) { return lifted(1); });
    const std::size_t begin = twice.waveform.samples.size();
    twice.run(0.05, [&](double) { return touch(2, 99); });
    const std::span<const float> again = std::span<const float>(twice.waveform.samples).subspan(begin);
    // Only the samples before the first generated segment, whose start depends on the time of a block.
    constexpr std::size_t compared = 20;
    ASSERT_GT(std::min(again.size(), once.waveform.samples.size()), compared);
    for (std::size_t i = 0; i < compared; ++i) {
        ASSERT_NEAR(again[i], once.waveform.samples[i], 1e-4F) << i;
    }
}

}  // namespace
}  // namespace haptoflow::engine
