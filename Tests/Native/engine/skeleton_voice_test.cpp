#include "engine/offline_renderer.hpp"
#include "inference/load_limits.hpp"
#include "inference/skeleton_generator.hpp"
#include "inference/skeleton_model.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <span>
#include <vector>

// A voice of a model with a skeleton: it sounds at once and goes on by itself, and the network only corrects it.

namespace haptoflow::engine {
namespace {

using haptoflow::testing::levelDecibels;
using testing::SimulatedDevice;

/// A network whose correction the tests know: one of the skeleton's own segments plus a tone, or a failure.
class ToneOnSkeleton final : public inference::SegmentGenerator {
public:
    explicit ToneOnSkeleton(const model::ModelFile& model) : skeleton_(skeleton::readNativeParts(model), 1) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        ++runs;
        if (fails) {
            throw inference::InferenceError("the network is broken");
        }
        skeleton_.generate(requests, segments);
        for (std::size_t index = 0; index < segments.size(); ++index) {
            segments[index] += addedMps2;
        }
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        skeleton_.levels(requests, levelsMps2);
    }

    float addedMps2 = 0.0F;
    bool fails = false;
    int runs = 0;

private:
    inference::SkeletonGenerator skeleton_;
};

class SkeletonVoiceTest : public ::testing::Test {
protected:
    model::ModelFile model_ = testing::calmSkeletonModel();
    ToneOnSkeleton network_{model_};

    /// A tip that slides along a plane at a constant speed.
    static ContactState slideAt(double seconds, float speedMps = 0.1F, std::uint32_t label = 0) {
        ContactState state = testing::slidingAt(static_cast<double>(speedMps) * seconds, speedMps);
        state.material.labels[0] = label;
        return state;
    }
    static std::optional<ContactState> slide(double seconds) { return slideAt(seconds); }

    static std::span<const float> played(const SimulatedDevice& device, double fromSeconds, double untilSeconds) {
        const auto first = static_cast<std::size_t>(fromSeconds * 2000.0);
        return std::span(device.waveform.samples)
            .subspan(first, static_cast<std::size_t>(untilSeconds * 2000.0) - first);
    }
    /// What 5 m/s^2 of the network add to 0.4 s of the wave, and how often the skeleton sounded alone. The filter rings
    /// on after what the network added to the past, so only gaps are told.
    std::pair<std::vector<float>, std::uint64_t> addedBy(double latencySeconds, const SimulatedDevice::Hand& hand,
                                                         double fromSeconds) {
        network_.addedMps2 = 5.0F;
        SimulatedDevice corrected(model_, network_, slowNetwork(latencySeconds));
        corrected.run(1.0, hand);
        network_.addedMps2 = 0.0F;
        SimulatedDevice plain(model_, network_, slowNetwork(latencySeconds));
        plain.run(1.0, hand);
        EXPECT_EQ(corrected.counters().underruns, 0U);
        std::vector<float> added(800);
        std::ranges::transform(played(corrected, fromSeconds, fromSeconds + 0.4),
                               played(plain, fromSeconds, fromSeconds + 0.4), added.begin(), std::minus<>());
        return {added, corrected.counters().sketched};
    }
    static testing::DeviceSettings slowNetwork(double seconds) {
        return {.latencySeconds = [seconds](double) { return seconds; }};
    }
};

TEST_F(SkeletonVoiceTest, TheFirstBlockOfATouchSoundsThoughTheModelHasNoSeed) {
    ASSERT_TRUE(model_.header().seeds.empty());
    SimulatedDevice device(model_, network_, slowNetwork(10.0));
    device.renderBlock();
    EXPECT_EQ(testing::peak(device.output), 0.0F);
    device.publish(slideAt(0.0));
    device.renderBlock();
    EXPECT_GT(testing::peak(device.output), 0.0F);
    EXPECT_EQ(device.counters().onsets, 1U);
}

TEST_F(SkeletonVoiceTest, HowOftenAnUnchangedContactIsToldDoesNotMatter) {
    // Without a network. The second hand reports half as often, so the other half of its states is guessed.
    std::vector<std::vector<float>> waves;
    for (const double updateHz : {128.0, 64.0}) {
        SimulatedDevice device(model_, network_,
                               {.blockFrames = 24,
                                .updateHz = updateHz,
                                .latencySeconds = [](double) { return 1000.0; },
                                .readsClock = true});
        device.run(1.0, slide);
        waves.push_back(device.waveform.samples);
    }
    ASSERT_EQ(waves[0].size(), waves[1].size());
    std::vector<float> difference(waves[0].size());
    std::ranges::transform(waves[0], waves[1], difference.begin(), std::minus<>());
    EXPECT_LT(levelDecibels(difference), levelDecibels(waves[0]) - 40.0);
}

TEST_F(SkeletonVoiceTest, ANewLabelSoundsFromTheBlockOnThatFollowsItsState) {
    for (const double latency : {0.002, 0.1}) {
        SimulatedDevice device(model_, network_, slowNetwork(latency));
        device.run(0.5, slide);
        SimulatedDevice other(model_, network_, slowNetwork(latency));
        other.run(0.5, slide);
        const std::size_t before = device.waveform.samples.size();
        device.publish(slideAt(0.5, 0.1F, 1));
        other.publish(slideAt(0.5, 0.1F, 0));
        device.renderBlock();
        other.renderBlock();
        const auto changed = std::span(device.waveform.samples).subspan(before, 8);
        const auto unchanged = std::span(other.waveform.samples).subspan(before, 8);
        EXPECT_FALSE(std::ranges::equal(changed, unchanged)) << "within 4 ms";
    }
}

TEST_F(SkeletonVoiceTest, TheNetworksCorrectionIsHeardWithoutGapsAcrossNewStates) {
    const auto [added, sketched] = addedBy(0.004, slide, 0.5);
    EXPECT_GT(std::ranges::min(added), 2.0F);
    EXPECT_LT(std::ranges::max(added), 15.0F);
    EXPECT_LE(sketched, 4U) << "only until the first segment";
}

TEST_F(SkeletonVoiceTest, ALateSegmentGivesItsCorrectionToTheStreamOfTheNewestState) {
    // 40 ms of inference, three states.
    const auto hand = [](double seconds) { return slideAt(seconds, 0.1F, seconds < 0.5 ? 0 : 1); };
    EXPECT_GT(std::ranges::min(addedBy(0.04, hand, 0.55).first), 1.0F);
}

TEST_F(SkeletonVoiceTest, WhenTheNetworkStallsForTenSecondsTheSkeletonGoesOnAtItsLevelAndIsCounted) {
    const auto latency = [](double seconds) { return seconds > 1.0 && seconds < 1.1 ? 10.0 : 0.002; };
    SimulatedDevice device(model_, network_, {.latencySeconds = latency});
    device.run(13.0, slide);
    for (double second = 0.5; second < 12.0; second += 0.5) {
        EXPECT_NEAR(levelDecibels(played(device, second, second + 0.5)), levelDecibels(played(device, 0.5, 12.5)), 3.0)
            << second;
    }
    EXPECT_EQ(device.counters().underruns, 0U);
    // 187.5 blocks a second, from 100 ms after the last segment on.
    EXPECT_NEAR(static_cast<double>(device.counters().sketched), 187.5 * 9.9, 40.0);
}

TEST_F(SkeletonVoiceTest, AFailingNetworkLeavesTheSkeletonSounding) {
    SimulatedDevice device(model_, network_, {});
    device.run(0.5, slide);
    network_.fails = true;
    device.run(2.0, slide);
    EXPECT_GT(device.counters().failures, 100U);
    EXPECT_NEAR(levelDecibels(played(device, 1.5, 2.4)), levelDecibels(played(device, 0.1, 0.5)), 3.0);
    network_.fails = false;
    const std::uint64_t sketched = device.counters().sketched;
    device.run(1.0, slide);
    EXPECT_LE(device.counters().sketched, sketched + 8) << "the network is heard again at once";
}

TEST_F(SkeletonVoiceTest, AnythingAtEveryStateForAMinuteStaysFiniteAndEndsInSilence) {
    network_.addedMps2 = 2.0F;
    std::mt19937 random(11);
    std::uniform_real_distribution<float> uniform;
    double busyUntil = 0.0;
    const auto latency = [&](double seconds) {
        busyUntil = uniform(random) < 0.02F ? seconds + 0.3 : busyUntil;
        return busyUntil > seconds ? 0.3 : 0.03 * static_cast<double>(uniform(random));
    };
    SimulatedDevice device(model_, network_, {.latencySeconds = latency});
    std::uint32_t touch = 1;
    device.run(60.0, [&](double seconds) -> std::optional<ContactState> {
        if (uniform(random) < 0.02F) {
            return std::nullopt;
        }
        ContactState state =
            slideAt(seconds, uniform(random) < 0.1F ? 20.0F : uniform(random), uniform(random) < 0.5F ? 0U : 1U);
        state.forceNewtons = uniform(random) < 0.01F ? std::numeric_limits<float>::quiet_NaN() : 5.0F * uniform(random);
        state.velocityMps[1] = uniform(random) < 0.01F ? std::numeric_limits<float>::infinity() : uniform(random);
        state.touching = uniform(random) < 0.05F ? 0U : 1U;
        touch += state.touching == 0 ? 1U : 0U;
        state.touchCounter = touch;
        state.spatialScale = uniform(random) < 0.1F ? 4.0F : 1.0F;
        state.hasPlace = uniform(random) < 0.3F ? 0U : 1U;
        network_.fails = uniform(random) < 0.05F;
        return state;
    });
    EXPECT_EQ(device.counters().nonFiniteSamples, 0U);
    EXPECT_EQ(device.counters().underruns, 0U);
    EXPECT_GT(device.counters().onsets, 50U);
    EXPECT_TRUE(std::ranges::all_of(device.waveform.samples, [](float sample) { return std::isfinite(sample); }));
    device.run(1.0, [&touch](double) { return testing::lifted(touch); });
    EXPECT_EQ(testing::peak(std::span(device.output).last(1000)), 0.0F);
}

TEST_F(SkeletonVoiceTest, AnOfflineRenderIsRefinedFromTheFirstSegmentOn) {
    const auto states = testing::statesOf(1.0, [](double seconds) { return slideAt(seconds); });
    const OfflineRender render = renderOffline(model_, network_, states, {.leadMs = 0.0});
    EXPECT_EQ(render.underruns, 0U);
    EXPECT_EQ(render.sketched, 0U);
    EXPECT_EQ(render.segments, 72U);
}

// The factor on a label's impulses reaches the worker and the callback's stream.
class ImpulseGainTest : public ::testing::Test {
protected:
    static model::ModelFile modelWith(float first, float second) {
        auto builder = skeleton::testing::skeletonModel({.seed = 5, .strength = 0.3F});
        builder.header["labels"][0]["impulse_gain"] = first;
        builder.header["labels"][1]["impulse_gain"] = second;
        return skeleton::testing::read(builder);
    }
    static ContactState slidingOver(const MaterialBlend& blend) {
        ContactState state = testing::sliding();
        state.material = blend;
        return state;
    }
};

TEST_F(ImpulseGainTest, ABlendHasTheMeanByWeight) {
    const model::ModelFile model = modelWith(0.5F, 3.0F);
    inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
    SimulatedDevice device(model, generator);
    device.voice().publisher.publish(slidingOver(testing::blendOf({{0, 0.75F}, {1, 0.25F}})));
    ASSERT_TRUE(device.voice().channels.toWorker.fetch());
    EXPECT_FLOAT_EQ(device.voice().channels.toWorker.current().material.impulseGain, 1.125F);
}

TEST_F(ImpulseGainTest, TheCallbacksStreamHasItToo) {
    const auto impulsesOf = [](float gain) {
        const model::ModelFile model = modelWith(gain, 1.0F);
        inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
        SimulatedDevice device(model, generator);
        device.voice().publisher.publish(slidingOver(testing::blendOf({{0, 1.0F}})));
        EXPECT_TRUE(device.voice().channels.toAudio.fetch());
        return device.voice().channels.toAudio.current().stream.skeleton.impulseGains;
    };
    const auto plain = impulsesOf(1.0F);
    const auto louder = impulsesOf(2.5F);
    EXPECT_NE(plain[0], 0.0F);
    for (std::size_t index = 0; index < plain.size(); ++index) {
        EXPECT_FLOAT_EQ(louder[index], 2.5F * plain[index]) << index;
    }
}

}  // namespace
}  // namespace haptoflow::engine
