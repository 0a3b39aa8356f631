#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;
using testing::SimulatedDevice;

constexpr double rateHz = 48000.0;
/// 60 dB below the tone's amplitude at a full scale of 60.
constexpr float silence = 1e-3F / 60.0F;

using LiveVoiceTest = testing::DeviceTest;

TEST_F(LiveVoiceTest, EveryFieldOfAContactStateReachesTheCallbackAndTheWorker) {
    // Every field has four bytes; a value of its own for each, also for those that are added later.
    std::array<float, sizeof(ContactState) / sizeof(float)> numbers{};
    for (std::size_t place = 0; place < numbers.size(); ++place) {
        numbers[place] = 0.3F + 0.01F * static_cast<float>(place);
    }
    auto state = std::bit_cast<ContactState>(numbers);
    (void)sanitise(state);
    SimulatedDevice device(model_, tone_);
    device.voice().publisher.publish(std::bit_cast<ContactState>(numbers));
    VoiceChannels& channels = device.voice().channels;
    ASSERT_TRUE(channels.toAudio.fetch());
    ASSERT_TRUE(channels.toWorker.fetch());
    EXPECT_EQ(std::memcmp(&channels.toAudio.current().contact.state, &state, sizeof(state)), 0);
    EXPECT_EQ(std::memcmp(&channels.toWorker.current().contact.state, &state, sizeof(state)), 0);
}

TEST_F(LiveVoiceTest, WithoutASkeletonTheSeedSoundsUntilTheFirstSegment) {
    SimulatedDevice device(model_, tone_, {.latencySeconds = [](double) { return 0.05; }});
    device.publish(testing::sliding());
    device.renderBlock();
    EXPECT_GT(testing::peak(device.output), 0.2F / 60.0F);
    device.run(0.3, slide);
    EXPECT_EQ(device.counters().underruns, 0U);
}

TEST_F(LiveVoiceTest, WhatLiesBelowTheRecordingsBandIsNotSentToTheActuator) {
    FakeGenerator constant(
        [](const inference::SegmentRequest&, std::span<float> segment) { std::ranges::fill(segment, 20.0F); });
    SimulatedDevice device(model_, constant);
    device.run(1.0, slide);
    EXPECT_EQ(device.waveform.samples.back(), 20.0F);
    EXPECT_LT(testing::peak(std::span<const float>(device.output).last(4800)), 0.02F / 60.0F);
}

TEST_F(LiveVoiceTest, ATapBetweenTwoBlocksSoundsForTenMilliseconds) {
    testing::SoundingModel sounding;
    SimulatedDevice device(sounding.model, sounding.generator);
    device.run(0.1, [](double) { return testing::lifted(0); });
    device.publish(touch(1));
    device.publish(testing::lifted(1));
    const std::size_t begin = device.output.size();
    renderBlocks(device, 8);
    EXPECT_GT(testing::peak(from(device, begin)), 100.0F * silence);
    EXPECT_LT(testing::peak(from(device, begin + 768)), silence) << "10 ms, a block and a fade of 5 ms";
    EXPECT_EQ(device.counters().taps, 1U);
}

TEST_F(LiveVoiceTest, NoSegmentOfAnEarlierTouchSoundsAfterANewOne) {
    // Segments of the first touch consist of the value 3, and one is still being generated when the second touch
    // begins.
    FakeGenerator threes(
        [](const inference::SegmentRequest&, std::span<float> segment) { std::ranges::fill(segment, 3.0F); });
    SimulatedDevice device(model_, threes, {.latencySeconds = [](double) { return 0.02; }});
    device.run(0.301, slide);
    EXPECT_GT(std::ranges::count(device.waveform.samples, 3.0F), 100);
    device.publish(testing::lifted(1));
    device.run(0.008, [](double) { return testing::lifted(1); });
    const std::uint64_t droppedBefore = device.counters().dropped;
    device.publish(touch(2));
    const std::size_t begin = device.waveform.samples.size();
    device.run(0.015, [](double) { return touch(2); });
    EXPECT_GE(device.counters().dropped, droppedBefore + 1) << "the segment of the first touch must be dropped";
    const auto output = std::span<const float>(device.waveform.samples).subspan(begin);
    EXPECT_GT(output.size(), 10U);
    EXPECT_EQ(std::ranges::count(output, 3.0F), 0) << "silence may follow, but nothing of the first touch";
}

TEST_F(LiveVoiceTest, AfterLiftOffTheVoiceIsSilentWithinABlockAndFiveMilliseconds) {
    for (const std::size_t block : {64U, 128U, 256U, 512U, 1024U}) {
        SimulatedDevice device(model_, tone_, {.blockFrames = block});
        device.run(0.4, slide);
        device.publish(testing::lifted());
        const std::size_t begin = device.output.size();
        device.run(0.2, [](double) { return testing::lifted(); });
        EXPECT_GT(testing::peak(device.output), 0.5F / 60.0F);
        EXPECT_LT(testing::peak(from(device, begin + block + 240)), silence) << block;
    }
}

TEST_F(LiveVoiceTest, AStaleContactFallsSilentAfter100MillisecondsAndResumesWithANewState) {
    SimulatedDevice device(model_, tone_);
    device.run(0.4, slide);
    device.publish(testing::sliding());
    const std::size_t begin = device.output.size();
    device.run(0.3, [](double) { return std::nullopt; });
    EXPECT_GT(testing::peak(from(device, begin).first(4000)), 0.5F / 60.0F);
    EXPECT_LT(testing::peak(from(device, begin + 4800 + 256 + 240)), silence);
    EXPECT_EQ(device.counters().staleStops, 1U);
    const std::size_t again = device.output.size();
    device.run(0.1, slide);
    EXPECT_GT(testing::peak(from(device, again)), 0.5F / 60.0F);
}

TEST_F(LiveVoiceTest, StatesThatComeSeldomByDesignAreNotStale) {
    for (const double period : {0.1, 0.15, 0.2}) {
        SimulatedDevice device(model_, tone_, {.updateHz = 1.0 / period});
        // The period is known before the touch.
        device.run(1.0, [](double) { return testing::lifted(); });
        device.run(3.0, slide);
        EXPECT_EQ(device.counters().staleStops, 0U) << period;
        const std::size_t begin = device.output.size();
        device.run(1.0, [](double) { return std::nullopt; });
        EXPECT_EQ(device.counters().staleStops, 1U) << period;
        const auto until = static_cast<std::size_t>(2.5 * period * rateHz) + 256 + 240;
        EXPECT_LT(testing::peak(from(device, begin + until)), silence) << period;
    }
}

TEST_F(LiveVoiceTest, APanicSilencesByTheEndOfTheNextBlockUntilANewTouch) {
    for (const std::size_t block : {64U, 256U}) {
        SimulatedDevice device(model_, tone_, {.blockFrames = block});
        device.run(0.4, slide);
        const float ordinaryStep = testing::largestStep(device.output);
        device.voice().channels.panic();
        const std::size_t begin = device.output.size();
        device.run(0.3, slide);
        EXPECT_LT(testing::peak(from(device, begin + block)), silence) << block;
        EXPECT_LT(testing::largestStep(from(device, begin - 1)),
                  ordinaryStep + 1.0F / 60.0F / static_cast<float>(block));
        // Sliding that stops and resumes belongs to the same touch.
        device.run(0.1, [](double) { return testing::sliding(0.0F); });
        device.run(0.1, slide);
        EXPECT_LT(testing::peak(from(device, begin + block)), silence);
        const std::size_t again = device.output.size();
        device.run(0.1, [](double) { return touch(2); });
        EXPECT_GT(testing::peak(from(device, again)), 0.5F / 60.0F);
    }
}

TEST_F(LiveVoiceTest, ARestingTipNeedsNoInferenceAndResumesAtOnce) {
    testing::SoundingModel sounding;
    SimulatedDevice device(sounding.model, sounding.generator);
    device.run(0.4, slide);
    device.run(0.1, [](double) { return testing::sliding(0.0F); });
    const std::uint64_t inferences = device.counters().inferences;
    const std::uint64_t skipped = device.counters().skipped;
    const std::size_t quiet = device.output.size();
    device.run(1.0, [](double) { return testing::sliding(0.0F); });
    EXPECT_EQ(device.counters().inferences, inferences);
    EXPECT_GE(device.counters().skipped, skipped + 70);
    EXPECT_EQ(testing::peak(from(device, quiet)), 0.0F);
    device.publish(testing::sliding());
    const std::size_t again = device.output.size();
    device.renderBlock();
    EXPECT_GT(testing::peak(from(device, again)), silence);
}

TEST_F(LiveVoiceTest, TheSplicesOfASteadySlideAreInaudible) {
    SimulatedDevice device(model_, tone_);
    device.run(2.0, slide);
    const auto& wave = device.waveform.samples;
    const double factor = 2.0 * std::cos(2.0 * std::numbers::pi * testing::toneHz / 2000.0);
    ASSERT_GT(wave.size(), 3500U);
    for (std::size_t i = 300; i < wave.size(); ++i) {
        ASSERT_NEAR(wave[i], factor * wave[i - 1] - wave[i - 2], 2e-3) << "sample " << i;
    }
    EXPECT_EQ(device.counters().underruns, 0U);
    EXPECT_EQ(device.counters().late, 0U);
    EXPECT_GT(device.waveform.seams.size(), 100U);
}

TEST_F(LiveVoiceTest, AStoppedDeviceEndsInference) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, slide);
    const std::uint64_t inferences = device.counters().inferences;
    for (int update = 0; update < 200; ++update) {
        device.publish(testing::sliding());
    }
    EXPECT_LE(device.counters().inferences, inferences + 1);
}

class StallTest : public LiveVoiceTest, public ::testing::WithParamInterface<double> {};

TEST_P(StallTest, ALateWorkerMakesNoStepAndTheVoiceRecovers) {
    const double stall = GetParam();
    const auto latency = [stall](double now) { return std::fmod(now, 1.0) < 0.014 && now > 0.5 ? stall : 0.002; };
    SimulatedDevice device(model_, tone_, {.latencySeconds = latency});
    device.run(4.9, slide);
    // The tone's steepest step, a fade of 10 samples, and a splice of 4 samples between two phases.
    const auto steady = std::span<const float>(device.waveform.samples).subspan(400);
    EXPECT_LE(testing::largestStep(steady), 0.32F + 2.0F / 4.0F);
    EXPECT_LE(testing::peak(device.output), 1.0F);
    if (stall >= 0.1) {
        EXPECT_GT(device.counters().underruns, 0U);
    }
    if (stall <= 0.02) {
        EXPECT_EQ(device.counters().underruns, 0U);
    }
    const std::size_t recent = device.output.size() - 9600;
    EXPECT_GT(testing::peak(from(device, recent)), 0.9F / 60.0F);
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, StallTest, ::testing::Values(0.005, 0.02, 0.1, 0.5));

struct Blocks {
    std::size_t frames;
    std::size_t burst;
};

class LeadTest : public LiveVoiceTest, public ::testing::WithParamInterface<Blocks> {};

TEST_P(LeadTest, TheEstimatedLeadIsShortAndFewSegmentsAreLate) {
    const auto [frames, burst] = GetParam();
    SimulatedDevice device(model_, tone_, {.blockFrames = frames, .burstBlocks = burst});
    device.run(10.0, slide);
    const double blockSamples = 2000.0 * static_cast<double>(frames * burst) / rateHz;
    EXPECT_EQ(device.counters().underruns, 0U);
    EXPECT_LE(device.counters().late, 15U) << "of 720";
    EXPECT_LE(device.counters().leadSamples, 4.0 + 2.0 * blockSamples + 2.0);
}

INSTANTIATE_TEST_SUITE_P(Device, LeadTest,
                         ::testing::Values(Blocks{64, 1}, Blocks{128, 1}, Blocks{256, 1}, Blocks{512, 1},
                                           Blocks{1024, 1}, Blocks{256, 2}, Blocks{512, 2}),
                         [](const auto& blocks) {
                             return std::to_string(blocks.param.frames) + "x" + std::to_string(blocks.param.burst);
                         });

TEST_F(LiveVoiceTest, AChangeOfTheOutputRateCausesOnlyAFade) {
    SimulatedDevice device(model_, tone_);
    device.run(0.5, slide);
    const std::uint64_t onsets = device.counters().onsets;
    const float ordinaryStep = testing::largestStep(device.output);
    device.setRate(24000.0);
    const std::size_t begin = device.output.size();
    device.run(0.5, slide);
    EXPECT_EQ(device.counters().rateChanges, 1U);
    EXPECT_EQ(device.counters().onsets, onsets) << "the touch continues";
    EXPECT_LE(testing::largestStep(from(device, begin - 1)), 3.0F * ordinaryStep);
    const auto settled = from(device, begin + 2400);
    EXPECT_GT(testing::peak(settled), 0.9F / 60.0F);
    int crossings = 0;
    for (std::size_t i = 1; i < settled.size(); ++i) {
        crossings += (settled[i - 1] < 0.0F) != (settled[i] < 0.0F) ? 1 : 0;
    }
    const double seconds = static_cast<double>(settled.size()) / 24000.0;
    EXPECT_NEAR(crossings / seconds, 2.0 * testing::toneHz, 10.0) << "the tone keeps its pitch";
}

struct Device {
    double rateHz;
    std::size_t blockFrames;
};

class DeviceChangeTest : public LiveVoiceTest, public ::testing::WithParamInterface<Device> {};

TEST_P(DeviceChangeTest, ADeviceChangeAtAnyMomentOfATouchCausesOnlyAFade) {
    const auto touchOfATenth = [](double time) {
        return std::optional(time >= 0.05 && time < 0.15 ? testing::sliding() : testing::lifted(time < 0.05 ? 0 : 1));
    };
    const double slowestHz = std::min(rateHz, GetParam().rateHz);
    const double steepest = haptoflow::testing::steepestStep(slowestHz);
    // Times from before the touch-down until after the lift-off, at the start of blocks and within them.
    for (double change = 0.045; change < 0.18; change += 0.0021) {
        SimulatedDevice device(model_, tone_);
        device.run(change, touchOfATenth);
        device.setRate(GetParam().rateHz);
        device.setBlock(GetParam().blockFrames);
        device.run(0.4 - change, touchOfATenth);
        ASSERT_TRUE(std::ranges::all_of(device.output, [](float sample) { return std::isfinite(sample); })) << change;
        EXPECT_EQ(device.counters().onsets, 1U) << change;
        EXPECT_GT(testing::peak(device.output), 0.5F / 60.0F) << change;
        EXPECT_LE(haptoflow::testing::largestStepFrom(0.0F, device.output), steepest * testing::peak(device.output))
            << change;
        EXPECT_EQ(testing::peak(from(device, device.output.size() - static_cast<std::size_t>(0.1 * slowestHz))), 0.0F)
            << change;
    }
}

INSTANTIATE_TEST_SUITE_P(To, DeviceChangeTest,
                         ::testing::Values(Device{44100.0, 256}, Device{24000.0, 128}, Device{96000.0, 480},
                                           Device{48000.0, 1024}, Device{16000.0, 333}),
                         [](const auto& device) {
                             return std::to_string(static_cast<int>(device.param.rateHz)) + "HzBlocksOf" +
                                    std::to_string(device.param.blockFrames);
                         });

TEST_F(LiveVoiceTest, TheCeilingHoldsForAnyNetworkOutput) {
    FakeGenerator loud([](const inference::SegmentRequest& request, std::span<float> segment) {
        for (std::size_t i = 0; i < segment.size(); ++i) {
            segment[i] = 1000.0F * request.noise[i];
        }
    });
    SimulatedDevice device(model_, loud);
    device.controls().ceiling = 0.25F;
    device.run(0.5, slide);
    EXPECT_LT(testing::peak(device.output), 0.25F);
    EXPECT_GT(testing::peak(device.output), 0.249F);
}

TEST_F(LiveVoiceTest, AfterAFailedRunTheVoiceFadesAtTheEndOfItsSegment) {
    int calls = 0;
    FakeGenerator failing([&calls](const inference::SegmentRequest& request, std::span<float> segment) {
        if (++calls > 20 && calls <= 40) {
            throw std::runtime_error("refused by the test");
        }
        testing::continueTone(request, segment);
    });
    SimulatedDevice device(model_, failing);
    device.run(1.5, slide);
    EXPECT_EQ(device.counters().failures, 20U);
    EXPECT_GT(device.counters().underruns, 0U);
    EXPECT_LE(testing::largestStep(std::span<const float>(device.waveform.samples).subspan(400)), 0.32F + 0.5F);
    EXPECT_GT(testing::peak(from(device, device.output.size() - 4800)), 0.9F / 60.0F);
}

TEST_F(LiveVoiceTest, EveryTouchingStateGetsASegmentOrIsCountedAsSkipped) {
    SimulatedDevice device(model_, tone_);
    std::uint64_t touching = 0;
    const auto stroke = [&](std::uint32_t number) {
        device.run(0.3, [&touching, number](double) {
            ++touching;
            return touch(number);
        });
    };
    stroke(1);
    device.controls().muted = true;
    stroke(1);
    device.controls().muted = false;
    stroke(1);
    device.run(0.1, [](double) { return testing::lifted(1); });
    stroke(2);
    device.run(0.1, [](double) { return testing::lifted(2); });
    // A state may have two consecutive segments, but every state must have a segment or be counted.
    EXPECT_GE(device.counters().skipped + device.counters().inferences, touching);
    EXPECT_GE(device.counters().skipped, 20U) << "the states published while muted";
    EXPECT_LE(device.counters().skipped, 30U);
}

TEST_F(LiveVoiceTest, DuringALongBlockEveryStateGetsASegmentAndTheNewestSounds) {
    // Pairs of blocks every 43 ms, states every 14 ms. The network outputs the requested speed.
    FakeGenerator speed([](const inference::SegmentRequest& request, std::span<float> segment) {
        std::ranges::fill(segment, 10.0F * request.motion[0]);
    });
    SimulatedDevice device(model_, speed, {.blockFrames = 1024, .burstBlocks = 2});
    device.run(0.5, slide);
    const std::uint64_t before = device.counters().inferences;
    device.run(4.3, slide);
    EXPECT_GE(device.counters().inferences - before, 290U) << "of 310 states";
    EXPECT_EQ(device.counters().underruns, 0U);
    for (const float mps : {0.11F, 0.12F, 0.2F}) {
        device.publish(testing::sliding(mps));
        device.run(0.004, [](double) { return std::nullopt; });
    }
    device.run(0.12, [](double) { return testing::sliding(0.2F); });
    EXPECT_FLOAT_EQ(device.waveform.samples.back(), 2.0F);
}

}  // namespace
}  // namespace haptoflow::engine
