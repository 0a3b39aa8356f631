#include "engine/silence.hpp"

#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::SimulatedDevice;

class SilenceTest : public testing::DeviceTest {
protected:
    static Silence reason(SimulatedDevice& device) { return device.voice().channels.silence.load(); }
};

TEST_F(SilenceTest, EachReasonForSilenceIsReportedAndSoundHasNone) {
    SimulatedDevice device(model_, tone_);
    EXPECT_EQ(reason(device), Silence::rest) << "before the first block";
    device.run(0.2, slide);
    EXPECT_EQ(reason(device), Silence::none);
    device.run(0.2, [](double) { return testing::sliding(0.0F); });
    EXPECT_EQ(reason(device), Silence::rest);
    device.run(0.2, slide);
    device.run(0.2, [](double) { return std::nullopt; });
    EXPECT_EQ(reason(device), Silence::stale);
    device.run(0.2, slide);
    device.controls().muted = true;
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::muted);
    device.controls().muted = false;
    device.controls().paused = true;
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::paused);
    device.controls().paused = false;
    device.setRate(1.0e6);
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::rate);
    device.setRate(48000.0);
    device.voice().channels.panic();
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::panic);
    device.workerAlive = false;
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::workerDead);
    device.controls().closing = true;
    device.run(0.05, slide);
    EXPECT_EQ(reason(device), Silence::closing);
}

TEST_F(SilenceTest, AStrengthOrACeilingOfZeroIsAReason) {
    for (const bool isCeiling : {false, true}) {
        SimulatedDevice device(model_, tone_);
        std::atomic<float>& gain = isCeiling ? device.controls().ceiling : device.controls().strength;
        device.run(0.2, slide);
        gain = 0.0F;
        device.run(0.05, slide);
        EXPECT_EQ(reason(device), Silence::turnedDown);
        EXPECT_EQ(testing::peak(std::span<const float>(device.output).last(480)), 0.0F);
        device.run(0.2, [](double) { return testing::lifted(1); });
        EXPECT_EQ(reason(device), Silence::turnedDown) << "it outlasts the rest";
        device.controls().muted = true;
        device.run(0.05, slide);
        EXPECT_EQ(reason(device), Silence::muted);
        device.controls().muted = false;
        gain = 0.01F;
        device.run(0.1, slide);
        EXPECT_EQ(reason(device), Silence::none);
        EXPECT_GT(testing::peak(std::span<const float>(device.output).last(480)), 0.0F);
    }
}

TEST_F(SilenceTest, OfSeveralReasonsTheMostPersistentIsReported) {
    SimulatedDevice device(model_, tone_);
    device.run(0.2, slide);
    device.voice().channels.panic();
    device.controls().closing = true;
    device.workerAlive = false;
    device.controls().paused = true;
    device.controls().muted = true;
    device.controls().strength = 0.0F;
    device.setRate(1.0e6);
    const auto next = [&](const std::function<void()>& remove) {
        device.run(0.05, slide);
        const Silence shown = reason(device);
        remove();
        return shown;
    };
    EXPECT_EQ(next([&] { device.controls().closing = false; }), Silence::closing);
    EXPECT_EQ(next([&] { device.workerAlive = true; }), Silence::workerDead);
    EXPECT_EQ(next([&] { device.controls().paused = false; }), Silence::paused);
    EXPECT_EQ(next([&] { device.controls().muted = false; }), Silence::muted);
    EXPECT_EQ(next([&] { device.controls().strength = 1.0F; }), Silence::turnedDown);
    EXPECT_EQ(next([&] { device.setRate(48000.0); }), Silence::rate);
    EXPECT_EQ(next([] {}), Silence::panic);
}

TEST_F(SilenceTest, AnUnsupportedRateIsCountedAndDoesNotWakeTheWorker) {
    for (const double impossible : {0.0, 1.0, -5.0, 7999.0, 192001.0, 1e9, std::numeric_limits<double>::quiet_NaN(),
                                    std::numeric_limits<double>::infinity()}) {
        SimulatedDevice device(model_, tone_);
        device.run(0.2, slide);
        std::vector<float> block(512, 1.0F);
        for (int i = 0; i < 3; ++i) {
            device.voice().renderer.render(block, impossible);
        }
        EXPECT_EQ(testing::peak(block), 0.0F) << impossible;
        EXPECT_EQ(device.counters().unsupportedRateBlocks, 3U) << impossible;
        EXPECT_EQ(reason(device), Silence::rate) << impossible;
        EXPECT_FALSE(device.voice().channels.isRateSupported) << impossible;
        EXPECT_EQ(device.voice().channels.requestedRateHz.load(), 0.0) << "the worker is not woken";
        device.run(0.1, slide);
        EXPECT_EQ(reason(device), Silence::none) << "back at a supported rate";
        EXPECT_TRUE(device.voice().channels.isRateSupported);
    }
}

TEST_F(SilenceTest, AnOnsetReadsOnlyItsBlockAndTheResamplersDelay) {
    // The filters' histories are filled directly, without rendering samples that are not played.
    for (const double rateHz : {8000.0, 48000.0, 192000.0}) {
        SimulatedDevice device(model_, tone_, {.rateHz = rateHz, .blockFrames = 64});
        device.publish(testing::sliding());
        device.renderBlock();
        EXPECT_LE(static_cast<double>(device.waveform.samples.size()), 2.0 + std::ceil(64.0 * 2000.0 / rateHz))
            << rateHz;
    }
}

TEST_F(SilenceTest, ATapInTheFirstPublishedStateSounds) {
    testing::SoundingModel sounding;
    SimulatedDevice device(sounding.model, sounding.generator);
    ContactState afterwards = testing::sliding();
    afterwards.touching = false;
    afterwards.touchCounter = 1;
    device.publish(afterwards);
    device.renderBlock();
    EXPECT_GT(testing::peak(device.output), 0.0F);
    EXPECT_EQ(device.counters().taps, 1U);
}

TEST_F(SilenceTest, CrossingTheEdgeOfTheRangeDoesNotClick) {
    // The trained range ends at 0.4 m/s. Beyond it the waveform is read faster; inside it the output equals the input.
    SimulatedDevice device(model_, tone_);
    device.run(0.3, slide);
    const std::size_t begin = device.output.size();
    device.run(3.0, [](double now) { return testing::sliding(std::fmod(now, 0.1) < 0.05 ? 0.39F : 0.6F); });
    const auto crossing = std::span<const float>(device.output).subspan(begin);
    // The 100 Hz tone is read at most 1.5 times faster and its level follows the range law; a click would be much
    // steeper.
    const double steepest = 2.0 * std::numbers::pi * 1.5 * testing::toneHz / 48000.0 * testing::peak(crossing);
    EXPECT_LE(testing::largestStep(crossing), 1.6 * steepest);
    EXPECT_EQ(device.counters().underruns, 0U);
}

}  // namespace
}  // namespace haptoflow::engine
