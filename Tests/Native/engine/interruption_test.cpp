#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::SimulatedDevice;

ContactState touch(std::uint32_t number, std::uint32_t label = 0) {
    ContactState state = testing::sliding();
    state.touchCounter = number;
    state.material.labels[0] = label;
    return state;
}

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

TEST_F(PanicTest, TouchesWithoutACounterAreSeparatedByLiftOff) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(0); });
    panic(device);
    device.run(0.1, [](double) { return touch(0); });
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

std::ostream& operator<<(std::ostream& stream, const Interruption& interruption) {
    return stream << interruption.name;
}

const std::vector<Interruption>& interruptions() {
    static const std::vector<Interruption> all{
        {"MissingStates", [](SimulatedDevice&) {}, [](SimulatedDevice&) {}, false},
        {"Pause", [](SimulatedDevice& device) { device.controls().paused = true; },
         [](SimulatedDevice& device) { device.controls().paused = false; }},
        {"Mute", [](SimulatedDevice& device) { device.controls().muted = true; },
         [](SimulatedDevice& device) { device.controls().muted = false; }},
        {"AnotherRate", [](SimulatedDevice& device) { device.setRate(1.0e6); },
         [](SimulatedDevice& device) { device.setRate(44100.0); }},
        {"RestingTip", [](SimulatedDevice&) {}, [](SimulatedDevice&) {}, false},
    };
    return all;
}

/// The states before and after the interruption: a change of level only, or of level, label and pose.
struct Motion {
    std::string name;
    ContactState before;
    ContactState after;
};

std::ostream& operator<<(std::ostream& stream, const Motion& motion) {
    return stream << motion.name;
}

ContactState moving(float speedMps, float forceNewtons, std::uint32_t label = 0) {
    ContactState state = testing::sliding(speedMps, forceNewtons);
    state.material.labels[0] = label;
    return state;
}

const std::vector<Motion>& motions() {
    static const std::vector<Motion> all{
        {"FromFastAndHardToSlowAndLight", moving(0.35F, 3.0F), moving(0.03F, 0.3F)},
        {"FromSlowAndLightToFastAndHard", moving(0.03F, 0.3F), moving(0.35F, 3.0F)},
        {"ToAnotherLabelWithAJumpOfPose", moving(0.35F, 3.0F, 0), moving(-0.05F, 0.4F, 1)},
        {"FromBeyondTheRangeToInsideIt", moving(15.0F, 8.0F), moving(0.05F, 0.5F)},
    };
    return all;
}

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
    const double first = haptoflow::testing::levelDecibels(firstSound(resumed, 1400));
    const double later = haptoflow::testing::levelDecibels(resumed.last(9600));
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
                         ::testing::Combine(::testing::ValuesIn(interruptions()), ::testing::ValuesIn(motions())),
                         [](const auto& test) { return std::get<0>(test.param).name + std::get<1>(test.param).name; });

TEST_F(PanicTest, AChangeOfStrengthWhileSoundingDoesNotClick) {
    SimulatedDevice device(model_, tone_);
    device.run(0.4, [](double) { return moving(0.3F, 2.0F); });
    const float ordinaryStep = testing::largestStep(device.output);
    const std::size_t begin = device.output.size();
    device.controls().strength = 0.0F;
    // The strength, the label and the pose change in the same block.
    device.run(0.1, [](double) { return moving(-0.1F, 0.5F, 1); });
    const auto gliding = std::span<const float>(device.output).subspan(begin - 1);
    EXPECT_LE(testing::largestStep(gliding), 1.3F * ordinaryStep);
    EXPECT_EQ(testing::peak(gliding.subspan(481)), 0.0F) << "the change must end after 10 ms";
}

TEST_F(PanicTest, AFirstTouchWithCounterZeroIsSilenced) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(0); });
    ASSERT_GT(testing::peak(device.output), audible);
    panic(device);
    const std::size_t begin = device.output.size();
    device.run(0.3, [](double) { return touch(0); });
    EXPECT_EQ(testing::peak(from(device, begin + 256)), 0.0F);
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

}  // namespace
}  // namespace haptoflow::engine
