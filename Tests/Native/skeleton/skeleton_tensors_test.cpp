#include "skeleton/skeleton_tensors.hpp"

#include "../model/refusal.hpp"
#include "model/model_error.hpp"
#include "skeleton_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace haptoflow::skeleton::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

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
