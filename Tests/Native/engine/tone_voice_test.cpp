#include "model/material_builder.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>

// Tone in the callback: the filter of a material and a surface on the generated waveform.

namespace haptoflow::engine {
namespace {

using effects::EffectKind;
using nlohmann::json;
using testing::lifted;
using testing::SimulatedDevice;
using testing::sliding;

/// A material with a tone of `gainDb` at every frequency.
model::MaterialFile materialOf(const model::ModelFile& model, double gainDb) {
    json text = model::testing::validMaterial(model::spaceOf(model.header()));
    text["tone"] = {{"speeds_mps", {0.1}}, {"frequencies_hz", {50.0, 500.0}}, {"gains_db", {{gainDb, gainDb}}}};
    text["level"]["log_levels"] = {0.0, 0.0, 0.0};
    text["level"]["force_exponent"] = 0.0;
    text["level_exponents"] = {{"speed", 0.0}, {"force", 0.0}};
    text["level_offset_db"] = 0.0;
    return model::parseMaterial(text.dump());
}

class ToneVoiceTest : public testing::DeviceTest {
protected:
    std::uint32_t registered(SimulatedDevice& on, double gainDb) {
        return static_cast<std::uint32_t>(
            on.library.add(materialOf(model_, gainDb), [this]() -> inference::LevelEstimator& { return tone_; }));
    }
    static const EffectCounters& toneOf(const SimulatedDevice& on) { return of(on, EffectKind::tone); }
    static ContactState on(std::uint32_t label) { return touch(1, label); }
};

TEST_F(ToneVoiceTest, WithoutAToneTheFilterDoesNotRun) {
    SimulatedDevice plain(model_, tone_);
    (void)registered(plain, 12.0);
    plain.run(1.0, [](double) { return on(0); });
    const EffectCounters& tone = toneOf(plain);
    EXPECT_EQ(tone.prepared + tone.runs + tone.samples + tone.nanoseconds + tone.events, 0U);
    EXPECT_EQ(plain.counters().requestedEffects & effects::maskOf(EffectKind::tone), 0U);
}

TEST_F(ToneVoiceTest, ATiltChangesTheGainAtTheSoundingFrequency) {
    SimulatedDevice plain(model_, tone_);
    SimulatedDevice dark(model_, tone_);
    plain.run(1.0, [](double) { return sliding(); });
    dark.run(1.0, [](double) {
        ContactState state = sliding();
        state.toneDbPerOctave = 6.0F;
        return state;
    });
    const double octaves = std::log2(testing::toneHz / 150.0);
    const std::span<const float> played(plain.waveform.samples);
    const std::span<const float> tilted(dark.waveform.samples);
    EXPECT_NEAR(testing::levelDecibels(tilted.last(1000)) - testing::levelDecibels(played.last(1000)), 6.0 * octaves,
                0.5);
}

TEST_F(ToneVoiceTest, AMaterialsToneAppliesFromTheSeedsFirstSampleAndNotToThePast) {
    SimulatedDevice plain(model_, tone_);
    SimulatedDevice toned(model_, tone_);
    const std::uint32_t soft = registered(plain, 0.0);
    const std::uint32_t loud = registered(toned, 12.0);
    plain.run(1.0, [soft](double) { return on(soft); });
    toned.run(1.0, [loud](double) { return on(loud); });
    ASSERT_EQ(plain.waveform.samples.size(), toned.waveform.samples.size());
    const float gain = std::pow(10.0F, 12.0F / 20.0F);
    for (std::size_t i = 0; i < plain.waveform.samples.size(); ++i) {
        ASSERT_NEAR(toned.waveform.samples[i], gain * plain.waveform.samples[i], 1e-3F) << i;
    }
    EXPECT_NEAR(testing::levelDecibels(toned.output) - testing::levelDecibels(plain.output), 12.0, 0.1);
    const EffectCounters& tone = toneOf(toned);
    EXPECT_EQ(tone.prepared, 1U);
    EXPECT_GT(tone.runs, 100U);
    EXPECT_GE(tone.samples, toned.waveform.samples.size());
    EXPECT_NE(toned.counters().requestedEffects & effects::maskOf(EffectKind::tone), 0U);
}

TEST_F(ToneVoiceTest, ANewTouchDoesNotUseTheToneOfTheTouchBefore) {
    SimulatedDevice once(model_, tone_);
    SimulatedDevice twice(model_, tone_);
    const std::uint32_t first = registered(once, 12.0);
    ASSERT_EQ(registered(twice, 12.0), first);
    once.run(0.05, [&](double) { return touch(1, first); });
    twice.run(0.5, [&](double) { return touch(1, 0); });
    twice.run(0.3, [](double) { return lifted(1); });
    const std::size_t begin = twice.waveform.samples.size();
    twice.run(0.05, [&](double) { return touch(2, first); });
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
