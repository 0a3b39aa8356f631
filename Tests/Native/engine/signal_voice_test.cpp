#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>

// A signal that replaces the texture: when it sounds, what does not run meanwhile, and how its latency is measured.

namespace haptoflow::engine {
namespace {

using effects::EffectKind;
using effects::maskOf;
using testing::lifted;
using testing::SimulatedDevice;
using testing::sliding;

class SignalVoiceTest : public testing::DeviceTest {
protected:
    static constexpr float fullScaleMps2 = 60.0F;
    static constexpr effects::SignalSettings tone200{.frequencyHz = 200.0F, .amplitudeMps2 = 6.0F};

    SignalVoiceTest() {
        nowSeconds = 0.0;
        device_.voice().channels.clock = +[]() noexcept { return nowSeconds; };
    }

    void setSignal(const effects::SignalSettings& settings) { device_.controls().signal = settings; }
    void play(double seconds, const ContactState& state) {
        begin_ = device_.output.size();
        device_.run(seconds, [&](double) { return state; });
    }
    /// The output of the last `play` from a time on.
    [[nodiscard]] std::span<const float> played(double fromSeconds = 0.0) const {
        const auto skipped = static_cast<std::size_t>(fromSeconds * 48000.0);
        return std::span<const float>(device_.output).subspan(begin_ + skipped);
    }
    [[nodiscard]] static bool isTone(std::span<const float> samples, double frequencyHz, double amplitude) {
        // From sin(x) + sin(x + 2 d) = 2 cos(d) sin(x + d), for any phase.
        const double factor = 2.0 * std::cos(2.0 * std::numbers::pi * frequencyHz / 48000.0);
        for (std::size_t i = 2; i < samples.size(); ++i) {
            const double expected = factor * static_cast<double>(samples[i - 1]) - static_cast<double>(samples[i - 2]);
            if (std::abs(expected - static_cast<double>(samples[i])) > 1e-6) {
                return false;
            }
        }
        return std::abs(static_cast<double>(testing::peak(samples)) - amplitude) < 1e-3 * amplitude;
    }
    static ContactState everything(float speedMps, std::uint32_t touch = 1) {
        ContactState state = sliding(speedMps);
        state.touchCounter = touch;
        state.approachSpeedMps = 0.5F;
        state.effects = maskOf(EffectKind::texture) | maskOf(EffectKind::impact) | maskOf(EffectKind::edge);
        state.toneDbPerOctave = 3.0F;
        return state;
    }

    SimulatedDevice device_{model_, tone_};
    std::size_t begin_ = 0;
    inline static double nowSeconds = 0.0;
};

TEST_F(SignalVoiceTest, TheSignalSoundsFrom5MmPerSecondIndependentOfForceAndSpeed) {
    setSignal(tone200);
    play(0.05, sliding(0.0049F));
    EXPECT_EQ(testing::peak(played()), 0.0F);
    for (const float speedMps : {0.005F, 0.15F, 2.0F, 20.0F}) {
        for (const float forceNewtons : {0.0F, 0.1F, 900.0F}) {
            play(0.05, sliding(speedMps, forceNewtons));
            EXPECT_TRUE(isTone(played(0.025), 200.0, 6.0 / fullScaleMps2)) << speedMps << " m/s, " << forceNewtons;
        }
    }
}

TEST_F(SignalVoiceTest, ASignalReplacesTextureImpactEdgeAndToneWithoutInference) {
    setSignal(tone200);
    for (std::uint32_t touch = 1; touch < 8; ++touch) {
        ContactState state = everything(0.2F, touch);
        state.edgeCounter = touch;
        state.edgeHeightMetres = 0.01F;
        state.landingCounter = touch / 2;
        state.material.labels[0] = touch % 2;
        play(0.1, state);
        EXPECT_TRUE(isTone(played(0.02), 200.0, 6.0 / fullScaleMps2));
        play(0.05, lifted(touch));
        EXPECT_EQ(testing::peak(played(0.03)), 0.0F);
    }
    for (const EffectKind kind : {EffectKind::texture, EffectKind::impact, EffectKind::edge, EffectKind::tone}) {
        EXPECT_EQ(
            of(device_, kind).prepared + of(device_, kind).runs + of(device_, kind).samples + of(device_, kind).events,
            0U);
    }
    EXPECT_EQ(device_.counters().inferences, 0U);
    EXPECT_EQ(device_.counters().onsets, 0U);
    EXPECT_EQ(tone_.generated, 0);
    EXPECT_EQ(of(device_, EffectKind::signal).prepared, 1U);
    EXPECT_EQ(of(device_, EffectKind::signal).events, 7U);
    EXPECT_GT(of(device_, EffectKind::signal).samples, 7U * 4800U / 2U);
}

TEST_F(SignalVoiceTest, MutePausePanicAndMissingStatesInterruptTheSignal) {
    setSignal(tone200);
    const auto isSilent = [this] { return testing::peak(played(0.02)) == 0.0F; };
    const auto sounds = [this] { return isTone(played(0.02), 200.0, 6.0 / fullScaleMps2); };
    play(0.1, sliding());
    ASSERT_TRUE(sounds());
    device_.controls().muted = true;
    play(0.1, sliding());
    EXPECT_TRUE(isSilent());
    device_.controls().muted = false;
    device_.controls().paused = true;
    play(0.1, sliding());
    EXPECT_TRUE(isSilent());
    EXPECT_EQ(device_.voice().channels.silence, Silence::paused);
    device_.controls().paused = false;
    play(0.1, sliding());
    EXPECT_TRUE(sounds());
    EXPECT_EQ(device_.voice().channels.silence, Silence::none);
    device_.voice().channels.panic();
    play(0.1, sliding());
    EXPECT_TRUE(isSilent());
    EXPECT_EQ(device_.voice().channels.silence, Silence::panic);
    const ContactState next = touch(2);
    play(0.1, next);
    EXPECT_TRUE(sounds());
    begin_ = device_.output.size();
    device_.run(0.3, [](double) { return std::nullopt; });
    EXPECT_EQ(testing::peak(played(0.13)), 0.0F);
    EXPECT_EQ(device_.voice().channels.silence, Silence::stale);
    play(0.1, next);
    EXPECT_TRUE(sounds());
    const double steepest = 0.1 * 2.0 * std::numbers::pi * (200.0 + 0.25 / 0.002) / 48000.0;
    EXPECT_LT(static_cast<double>(testing::largestStep(device_.output)), steepest);
    EXPECT_EQ(device_.counters().signalStarts.count, 1U) << "the other changes were not caused by a contact state";
    EXPECT_EQ(device_.counters().signalStops.count, 0U);
}

TEST_F(SignalVoiceTest, TheLatencyIsMeasuredFromTheStateToTheBlockOfTheChange) {
    setSignal(tone200);
    nowSeconds = 100.0;
    device_.publish(sliding(0.001F));
    device_.renderBlock();
    nowSeconds = 101.0;
    device_.publish(sliding(0.15F));
    nowSeconds = 101.004;
    device_.publish(sliding(0.16F));
    nowSeconds = 101.010;
    device_.renderBlock();
    const SignalTransitions& starts = device_.counters().signalStarts;
    const SignalTransitions& stops = device_.counters().signalStops;
    EXPECT_EQ(starts.count, 1U);
    EXPECT_NEAR(starts.lastSeconds, 0.010, 1e-9);
    nowSeconds = 102.0;
    device_.publish(sliding(0.0F));
    nowSeconds = 102.020;
    device_.renderBlock();
    EXPECT_EQ(stops.count, 1U);
    EXPECT_NEAR(stops.lastSeconds, 0.020, 1e-9);
    nowSeconds = 103.0;
    device_.publish(sliding(0.2F));
    nowSeconds = 103.030;
    device_.renderBlock();
    EXPECT_EQ(starts.count, 2U);
    EXPECT_NEAR(starts.lastSeconds, 0.030, 1e-9);
    EXPECT_NEAR(starts.meanSeconds, 0.020, 1e-9);
    EXPECT_NEAR(stops.meanSeconds, 0.020, 1e-9);
    // Two changes between two blocks cancel each other and do not count.
    device_.publish(lifted());
    device_.publish(sliding(0.2F));
    device_.renderBlock();
    EXPECT_EQ(starts.count, 2U);
    EXPECT_EQ(stops.count, 1U);
}

}  // namespace
}  // namespace haptoflow::engine
