#include "simulated_device.hpp"

#include "engine/silence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::SimulatedDevice;

class PanicTest : public testing::DeviceTest {
protected:
    static void panic(SimulatedDevice& device) { device.voice().channels.panic(); }
};

constexpr float audible = 0.2F / 60.0F;

TEST_F(PanicTest, ATouchAfterAPanicInSilenceSoundsInTheNextBlock) {
    testing::SoundingModel sounding;
    for (const std::uint32_t number : {0U, 1U, 7U}) {
        SimulatedDevice device(sounding.model, sounding.generator);
        device.run(0.05, [](double) { return testing::lifted(0); });
        panic(device);
        device.publish(touch(number));
        const std::size_t begin = device.output.size();
        device.renderBlock();
        EXPECT_GT(testing::peak(from(device, begin)), 0.0F) << "touch " << number;
    }
}

TEST_F(PanicTest, ANewTouchInTheSameBlockSoundsAfterTheOldOneIsSilent) {
    testing::SoundingModel sounding;
    SimulatedDevice device(sounding.model, sounding.generator);
    device.run(0.3, [](double) { return touch(1); });
    const float ordinaryStep = testing::largestStep(device.output);
    panic(device);
    device.publish(touch(2, 1));
    const std::size_t begin = device.output.size();
    device.renderBlock();
    EXPECT_EQ(device.output.back(), 0.0F) << "the old touch must end with its block";
    device.renderBlock();
    EXPECT_GT(testing::peak(from(device, begin + 256)), 0.0F) << "the new touch must sound with the next block";
    EXPECT_LE(testing::largestStep(from(device, begin - 1)), 3.0F * ordinaryStep);
}

TEST_F(PanicTest, ATouchWithoutACounterIsSilencedUntilLiftOff) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(0); });
    ASSERT_GT(testing::peak(device.output), audible);
    panic(device);
    const std::size_t silenced = device.output.size();
    device.run(0.3, [](double) { return touch(0); });
    EXPECT_EQ(testing::peak(from(device, silenced + 256)), 0.0F);
    device.run(0.05, [](double) { return testing::lifted(0); });
    const std::size_t begin = device.output.size();
    device.run(0.1, [](double) { return touch(0); });
    EXPECT_GT(testing::peak(from(device, begin)), audible);
}

TEST_F(PanicTest, ASecondPanicAlsoSilencesTheTouchBetween) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(1); });
    panic(device);
    device.publish(touch(2));
    panic(device);
    const std::size_t begin = device.output.size();
    device.run(0.2, [](double) { return touch(2); });
    EXPECT_EQ(testing::peak(from(device, begin + 256)), 0.0F);
    const std::size_t again = device.output.size();
    device.run(0.1, [](double) { return touch(3); });
    EXPECT_GT(testing::peak(from(device, again)), audible);
}

TEST_F(PanicTest, AnEmptyBlockDoesNotEndAPanic) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(1); });
    const float ordinaryStep = testing::largestStep(device.output);
    panic(device);
    device.voice().renderer.render({}, 48000.0);
    const std::size_t begin = device.output.size();
    device.renderBlock();
    EXPECT_LE(testing::largestStep(from(device, begin - 1)), 3.0F * ordinaryStep)
        << "the output must fade without a step";
    EXPECT_EQ(device.output.back(), 0.0F);
}

using testing::MotionGenerator;

/// An interruption of the sound of a continuing touch: how it begins and how it ends.
struct Interruption {
    std::string name;
    std::function<void(SimulatedDevice&)> begin;
    std::function<void(SimulatedDevice&)> end;
    /// Whether states are published during the interruption.
    bool isPublished = true;
};

const std::vector<Interruption> interruptions{
    {"MissingStates", [](SimulatedDevice&) {}, [](SimulatedDevice&) {}, false},
    {"Pause", [](SimulatedDevice& device) { device.controls().paused = true; },
     [](SimulatedDevice& device) { device.controls().paused = false; }},
    {"Mute", [](SimulatedDevice& device) { device.controls().muted = true; },
     [](SimulatedDevice& device) { device.controls().muted = false; }},
    {"AnotherRate", [](SimulatedDevice& device) { device.setRate(1.0e6); },
     [](SimulatedDevice& device) { device.setRate(44100.0); }},
    {"RestingTip", [](SimulatedDevice&) {}, [](SimulatedDevice&) {}, false},
};

/// The states before and after the interruption: a change of level only, or of level, label and pose.
struct Motion {
    std::string name;
    ContactState before;
    ContactState after;
};

ContactState moving(float speedMps, float forceNewtons, std::uint32_t label = 0) {
    ContactState state = testing::sliding(speedMps, forceNewtons);
    state.material.labels[0] = label;
    return state;
}

const std::vector<Motion> motions{
    {"FromFastAndHardToSlowAndLight", moving(0.35F, 3.0F), moving(0.03F, 0.3F)},
    {"FromSlowAndLightToFastAndHard", moving(0.03F, 0.3F), moving(0.35F, 3.0F)},
    {"ToAnotherLabelWithAJumpOfPose", moving(0.35F, 3.0F, 0), moving(-0.05F, 0.4F, 1)},
    {"FromBeyondTheRangeToInsideIt", moving(15.0F, 8.0F), moving(0.05F, 0.5F)},
};

class InterruptionTest : public ::testing::TestWithParam<std::tuple<Interruption, Motion>> {
protected:
    [[nodiscard]] const Interruption& interruption() const { return std::get<0>(GetParam()); }
    [[nodiscard]] const Motion& motion() const { return std::get<1>(GetParam()); }

    /// Slides, interrupts for 150 ms while the motion changes, and resumes. Returns the index of the first resumed
    /// sample.
    std::size_t interrupt(SimulatedDevice& device) const {
        device.run(0.4, [this](double) { return motion().before; });
        interruption().begin(device);
        device.run(0.15, [this](double) -> std::optional<ContactState> {
            if (interruption().name == "RestingTip") {
                ContactState resting = motion().before;
                resting.velocityMps = {};
                return resting;
            }
            return interruption().isPublished ? std::optional(motion().after) : std::nullopt;
        });
        const std::size_t end = device.output.size();
        EXPECT_LT(testing::peak(std::span<const float>(device.output).subspan(end - 1000)), 1e-9F)
            << "the interruption must be silent";
        interruption().end(device);
        return end;
    }

    model::ModelFile model_ = testing::smallModel();
    MotionGenerator generator_;
};

std::span<const float> firstSound(std::span<const float> output, std::size_t frames) {
    const auto first = std::ranges::find_if(output, [](float sample) { return sample != 0.0F; });
    const auto begin = static_cast<std::size_t>(first - output.begin());
    return output.subspan(begin, std::min(frames, output.size() - begin));
}

TEST_P(InterruptionTest, AResumedTouchHasTheLevelOfItsFirstState) {
    // The first 30 ms have the level of the seed, later samples that of the network.
    SimulatedDevice device(model_, generator_);
    const std::size_t end = interrupt(device);
    // At a reading rate of four, a segment ends before a contact is stale, so some underruns are allowed.
    const std::uint64_t underrunsBefore = device.counters().underruns;
    device.run(0.4, [this](double) { return motion().after; });
    const auto resumed = std::span<const float>(device.output).subspan(end);
    const double first = testing::levelDecibels(firstSound(resumed, 1400));
    const double later = testing::levelDecibels(resumed.last(9600));
    EXPECT_NEAR(first, later, 2.5);
    EXPECT_EQ(device.counters().underruns, underrunsBefore);
}

TEST_P(InterruptionTest, AStrengthSetInSilenceAppliesFromTheFirstSample) {
    SimulatedDevice device(model_, generator_);
    const std::size_t end = interrupt(device);
    device.controls().strength = 0.0F;
    device.run(0.2, [this](double) { return motion().after; });
    EXPECT_EQ(testing::peak(std::span<const float>(device.output).subspan(end)), 0.0F);
}

TEST_P(InterruptionTest, ResumptionsAreCountedSeparatelyFromTouches) {
    SimulatedDevice device(model_, generator_);
    (void)interrupt(device);
    device.run(0.2, [this](double) { return motion().after; });
    // A resting tip ends the slide, so the next slide is a new onset.
    const bool isRest = interruption().name == "RestingTip";
    EXPECT_EQ(device.counters().onsets, isRest ? 2U : 1U);
    EXPECT_EQ(device.counters().resumptions, isRest ? 0U : 1U);
}

INSTANTIATE_TEST_SUITE_P(Of, InterruptionTest,
                         ::testing::Combine(::testing::ValuesIn(interruptions), ::testing::ValuesIn(motions)),
                         [](const auto& test) { return std::get<0>(test.param).name + std::get<1>(test.param).name; });

TEST_F(PanicTest, AChangeOfStrengthWhileSoundingDoesNotClick) {
    SimulatedDevice device(model_, tone_);
    device.run(0.4, [](double) { return moving(0.3F, 2.0F); });
    const float ordinaryStep = testing::largestStep(device.output);
    const std::size_t begin = device.output.size();
    device.controls().strength = 0.0F;
    // The strength, the label and the pose change in the same block.
    device.run(0.1, [](double) { return moving(-0.1F, 0.5F, 1); });
    const auto gliding = from(device, begin - 1);
    EXPECT_LE(testing::largestStep(gliding), 1.3F * ordinaryStep);
    EXPECT_EQ(testing::peak(gliding.subspan(481)), 0.0F) << "the change must end after 10 ms";
}

TEST_P(InterruptionTest, ACeilingSetInSilenceAppliesFromTheFirstSample) {
    SimulatedDevice device(model_, generator_, {.fullScaleMps2 = 0.01F});
    const std::size_t end = interrupt(device);
    device.controls().ceiling = 0.1F;
    device.run(0.2, [this](double) { return motion().after; });
    const float loudest = testing::peak(std::span<const float>(device.output).subspan(end));
    EXPECT_LT(loudest, 0.1F);
    EXPECT_GT(loudest, 0.05F);
}

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
    const auto crossing = from(device, begin);
    // The 100 Hz tone is read at most 1.5 times faster and its level follows the range law; a click would be much
    // steeper.
    const double steepest = 2.0 * std::numbers::pi * 1.5 * testing::toneHz / 48000.0 * testing::peak(crossing);
    EXPECT_LE(testing::largestStep(crossing), 1.6 * steepest);
    EXPECT_EQ(device.counters().underruns, 0U);
}

}  // namespace
}  // namespace haptoflow::engine
