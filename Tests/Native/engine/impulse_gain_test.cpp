#include "../skeleton/skeleton_model.hpp"
#include "engine/offline_renderer.hpp"
#include "inference/skeleton_generator.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

// The factor on a label's impulses reaches the worker, the callback's sketch and each part of a blend.

namespace haptoflow::engine {
namespace {

using testing::SimulatedDevice;

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
    static std::vector<float> rendered(const model::ModelFile& model, std::uint32_t label) {
        inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
        std::vector<TimedContactState> states(36);
        for (std::size_t update = 0; update < states.size(); ++update) {
            static_cast<ContactState&>(states[update]) = slidingOver(testing::blendOf({{label, 1.0F}}));
            states[update].timeSeconds = static_cast<double>(update) / 72.0;
        }
        return renderOffline(model, generator, states, {}).samples;
    }
};

TEST_F(ImpulseGainTest, ABlendHasTheMeanByWeightAndEachOfItsPartsItsOwn) {
    const model::ModelFile model = modelWith(0.5F, 3.0F);
    inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
    SimulatedDevice device(model, generator);
    device.voice().publisher.publish(slidingOver(testing::blendOf({{0, 0.75F}, {1, 0.25F}})));
    ASSERT_TRUE(device.voice().channels.toWorker.fetch());
    const WorkerMessage& told = device.voice().channels.toWorker.current();
    EXPECT_FLOAT_EQ(told.material.impulseGain, 1.125F);
    ASSERT_EQ(told.blend.count, 2U);
    EXPECT_EQ(told.blend.parts[0].impulseGain, 0.5F);
    EXPECT_EQ(told.blend.parts[1].impulseGain, 3.0F);
}

TEST_F(ImpulseGainTest, TheCallbacksSketchHasItToo) {
    const auto rungsOf = [](float gain) {
        const model::ModelFile model = modelWith(gain, 1.0F);
        inference::SkeletonGenerator generator(skeleton::readNativeParts(model), 4);
        SimulatedDevice device(model, generator);
        device.voice().publisher.publish(slidingOver(testing::blendOf({{0, 1.0F}})));
        EXPECT_TRUE(device.voice().channels.toAudio.fetch());
        return device.voice().channels.toAudio.current().sketch.parameters.rungs;
    };
    const auto plain = rungsOf(1.0F);
    const auto louder = rungsOf(2.5F);
    EXPECT_NE(plain[0], 0.0F);
    for (std::size_t index = 0; index < plain.size(); ++index) {
        EXPECT_FLOAT_EQ(louder[index], 2.5F * plain[index]) << index;
    }
}

TEST_F(ImpulseGainTest, AFactorChangesItsOwnLabelAloneAndOneChangesNothing) {
    auto builder = skeleton::testing::skeletonModel({.seed = 5, .strength = 0.3F});
    const model::ModelFile without = skeleton::testing::read(builder);
    EXPECT_EQ(rendered(modelWith(1.0F, 1.0F), 0), rendered(without, 0));
    EXPECT_NE(rendered(modelWith(3.0F, 1.0F), 0), rendered(without, 0));
    EXPECT_EQ(rendered(modelWith(3.0F, 1.0F), 1), rendered(without, 1));
}

}  // namespace
}  // namespace haptoflow::engine
