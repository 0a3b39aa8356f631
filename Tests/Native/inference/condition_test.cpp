#include "skeleton/condition.hpp"
#include "../model/refusal.hpp"
#include "model/model_error.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace haptoflow::skeleton::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

TEST(MotionFeaturesTest, RestAndANegativeForceAreFinite) {
    const auto logarithms = logMotionOf({0.0F, 0.0F, -3.0F});
    EXPECT_NEAR(logarithms.speed, std::log(0.0005 / 0.06), 1e-6);
    EXPECT_NEAR(logarithms.force, std::log(0.02), 1e-6);
}

TEST(ConditionTest, NumbersThatAreNotFiniteCountAsZero) {
    std::array<float, embeddingSize> embedding{};
    embedding[3] = std::numeric_limits<float>::quiet_NaN();
    embedding[4] = std::numeric_limits<float>::infinity();
    embedding[5] = 2.0F;
    const Motion broken{std::numeric_limits<float>::quiet_NaN(), 0.1F, std::numeric_limits<float>::infinity()};
    const Phases phases{
        0.0F, 0.0F, 0.0F, std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity(), 60.0F};
    const Condition condition = conditionOf(embedding, broken, phases);
    std::array<float, embeddingSize> clean{};
    clean[5] = 2.0F;
    EXPECT_EQ(condition, conditionOf(clean, {0.0F, 0.1F, 0.0F}, {0.0F, 0.0F, 0.0F, 0.0F, 0.0F, 60.0F}));
}

std::vector<float> randomNumbers(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<float> values(count);
    for (float& value : values) {
        value = normal(random);
    }
    return values;
}

TEST(LinearLayerTest, EveryNumberOfOutputsGivesTheProductOfMatrixAndVector) {
    for (const std::size_t outputs : {1U, 3U, 4U, 5U, 15U, 16U, 17U, 25U, 38U, 130U}) {
        constexpr std::size_t inputs = 7;
        const auto weight = randomNumbers(outputs * inputs, 1);
        const auto bias = randomNumbers(outputs, 2);
        const auto x = randomNumbers(inputs, 3);
        // One number more shows that nothing is written beyond the outputs.
        std::vector<float> y(outputs + 1, 99.0F);
        LinearLayer(weight, bias).apply(x, y);
        for (std::size_t output = 0; output < outputs; ++output) {
            double expected = bias[output];
            for (std::size_t input = 0; input < inputs; ++input) {
                expected += static_cast<double>(weight[output * inputs + input]) * static_cast<double>(x[input]);
            }
            EXPECT_NEAR(y[output], expected, 1e-5) << outputs << " outputs, output " << output;
        }
        EXPECT_EQ(y[outputs], 99.0F);
    }
}

TEST(PerceptronTest, HugeInputsStayFinite) {
    const std::array<float, 1> weight{1e6F};
    const std::array<float, 1> bias{0.0F};
    const Perceptron perceptron({{weight, bias}, {weight, bias}}, {weight, bias});
    for (const float x : {1e6F, -1e6F}) {
        std::array<float, 1> y{};
        perceptron.run(std::array<float, 1>{x}, y);
        EXPECT_TRUE(std::isfinite(y[0])) << x;
    }
}

/// The message with which reading the skeleton or the level is refused.
std::string refusalOf(const model::testing::ModelBuilder& builder) {
    const model::ModelFile model = read(builder);
    try {
        (void)readSkeleton(model);
        (void)readLevelModel(model);
    } catch (const model::ModelError& error) {
        EXPECT_EQ(error.status(), model::ModelStatus::inconsistent);
        return error.what();
    }
    return "it was accepted";
}

TEST(SkeletonTensorsTest, ACompleteModelIsRead) {
    const model::ModelFile model = read(skeletonModel());
    EXPECT_NE(readSkeleton(model), nullptr);
    EXPECT_NE(readLevelModel(model), nullptr);
}

TEST(SkeletonTensorsTest, AMissingTensorIsNamedWithTheRemedy) {
    for (const std::string name : {"skeleton.0.weight", "skeleton.2.bias", "skeleton.4.bias", "level.law.weight",
                                   "level.law.bias", "level.correction.4.weight"}) {
        auto builder = skeletonModel();
        std::erase_if(builder.blobs, [&name](const auto& blob) { return blob.name == name; });
        EXPECT_THAT(refusalOf(builder), AllOf(HasSubstr('"' + name + '"'), HasSubstr("export the model again")));
    }
}

TEST(SkeletonTensorsTest, AWrongShapeIsNamedWithTheExpectedOne) {
    auto builder = skeletonModel();
    blobOf(builder, "skeleton.0.weight").shape = {48, 44};
    EXPECT_THAT(refusalOf(builder), HasSubstr("blob \"skeleton.0.weight\" has the shape [48, 44]; expected [any, 88]"));
    builder = skeletonModel();
    blobOf(builder, "level.law.weight").shape = {192};
    EXPECT_THAT(refusalOf(builder), HasSubstr("blob \"level.law.weight\" has the shape [192]; expected [3, 64]"));
    builder = skeletonModel();
    blobOf(builder, "skeleton.2.bias").shape = {24, 1};
    EXPECT_THAT(refusalOf(builder), HasSubstr("blob \"skeleton.2.bias\" has the shape [24, 1]; expected [24]"));
}

TEST(SkeletonTensorsTest, MoreHiddenUnitsThanTheBuffersHoldAreRefused) {
    auto builder = skeletonModel();
    for (const std::string part : {"weight", "bias"}) {
        auto& blob = blobOf(builder, "level.correction.0." + part);
        blob.shape[0] = 513;
        blob.bytes.resize(513 * (part == "weight" ? LevelModel::correctionInputs : 1) * sizeof(float));
    }
    EXPECT_THAT(refusalOf(builder), HasSubstr("blob \"level.correction.0.weight\" has 513 rows; expected at most 512"));
    EXPECT_EQ(refusalOf(skeletonModel({.hidden = 512})), "it was accepted");
}

TEST(SkeletonTensorsTest, WeightsThatAreNotFiniteAreRefusedWhenTheFileIsRead) {
    for (const float weight : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e6F}) {
        for (const std::string name : {"skeleton.2.weight", "level.correction.0.bias"}) {
            auto builder = skeletonModel();
            auto& bytes = blobOf(builder, name).bytes;
            const auto changed = model::testing::bytesOf({weight});
            std::ranges::copy(changed, bytes.begin() + 8);
            model::testing::expectRefusal(builder.build(), model::ModelStatus::inconsistent,
                                          "tensor \"" + name + "\": number 2");
        }
    }
}

TEST(SkeletonTensorsTest, TheConditioningOfARefiningTierIsReadByItsName) {
    auto builder = skeletonModel();
    for (const auto& part : {"0.weight", "0.bias", "2.weight", "2.bias", "4.weight", "4.bias"}) {
        auto copy = blobOf(builder, std::string("skeleton.") + part);
        copy.name = std::string("fine.condition.") + part;
        builder.blobs.push_back(copy);
    }
    EXPECT_EQ(readConditioning(read(builder), "fine").outputs(), 269U);
    EXPECT_THROW((void)readConditioning(read(builder), "draft"), model::ModelError);
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
