#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;
using testing::SimulatedDevice;

ContactState touch(std::uint32_t number, std::uint32_t label = 0) {
    ContactState state = testing::sliding();
    state.touchCounter = number;
    state.material.labels[0] = label;
    return state;
}

class PanicTest : public ::testing::Test {
protected:
    model::ModelFile model_ = testing::smallModel();
    FakeGenerator tone_{testing::continueTone};

    static void panic(SimulatedDevice& device) { device.voice().channels.panic(); }
    static std::span<const float> from(const SimulatedDevice& device, std::size_t frame) {
        return std::span<const float>(device.output).subspan(frame);
    }
};

constexpr float audible = 0.2F / 60.0F;

TEST_F(PanicTest, ATouchAfterAPanicInSilenceSoundsInTheNextBlock) {
    for (const std::uint32_t number : {0U, 1U, 7U}) {
        SimulatedDevice device(model_, tone_);
        device.run(0.05, [](double) { return testing::lifted(0); });
        panic(device);
        device.publish(touch(number));
        const std::size_t begin = device.output.size();
        device.renderBlock();
        EXPECT_GT(testing::peak(from(device, begin)), audible) << "touch " << number;
    }
}

TEST_F(PanicTest, ANewTouchInTheSameBlockSoundsAfterTheOldOneIsSilent) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, [](double) { return touch(1); });
    const float ordinaryStep = testing::largestStep(device.output);
    panic(device);
    device.publish(touch(2, 1));
    const std::size_t begin = device.output.size();
    device.renderBlock();
    EXPECT_EQ(device.output.back(), 0.0F) << "the old touch must end with its block";
    device.renderBlock();
    EXPECT_GT(testing::peak(from(device, begin + 256)), audible) << "the new touch must sound with the next block";
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

}  // namespace
}  // namespace haptoflow::engine
