#include "../skeleton/skeleton_model.hpp"
#include "model/file_layout.hpp"
#include "model/plain_text.hpp"
#include "refusal.hpp"

#include <functional>
#include <string>

// The keys of models whose tiers use a skeleton.

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;
using skeleton::testing::refinedModel;

void expectSkeletonRefusal(const std::function<void(ModelBuilder&)>& change, const std::string& part) {
    ModelBuilder builder = refinedModel();
    change(builder);
    testing::expectRefusal(builder.build(), ModelStatus::inconsistent, part);
}

TEST(SkeletonHeaderTest, TiersOfBothKindsAreRead) {
    const ModelFile model = ModelFile::parse(refinedModel().build());
    const Tier& sketch = model.header().tiers[0];
    EXPECT_EQ(sketch.kind, TierKind::skeleton);
    EXPECT_EQ(sketch.field, "");
    EXPECT_EQ(sketch.level, "");
    EXPECT_EQ(sketch.parameters, 12345);
    EXPECT_EQ(sketch.steps, 1);
    EXPECT_TRUE(sketch.usesSkeleton());
    EXPECT_FALSE(sketch.isSolved());
    EXPECT_FALSE(sketch.needsOnnxRuntime());
    const Tier& standard = model.header().tiers[1];
    EXPECT_EQ(standard.kind, TierKind::refine);
    EXPECT_EQ(standard.field, "standard.field");
    EXPECT_EQ(standard.level, "");
    EXPECT_TRUE(standard.usesSkeleton());
    EXPECT_FALSE(standard.isSolved());
    EXPECT_TRUE(standard.needsOnnxRuntime());
    ASSERT_TRUE(model.header().skeleton);
    EXPECT_EQ(model.header().skeleton->hidden, 24);
    EXPECT_EQ(model.header().skeleton->parameters, 12345);
    EXPECT_EQ(kindName(TierKind::skeleton), "skeleton");
    EXPECT_EQ(kindName(TierKind::refine), "refine");
    EXPECT_TRUE(model.header().seeds.empty());
    EXPECT_THROW((void)model.seed(0), std::out_of_range);
}

TEST(SkeletonHeaderTest, AModelWithoutSuchTiersNeedsNoSkeleton) {
    EXPECT_FALSE(ModelFile::parse(ModelBuilder().build()).header().skeleton);
}

TEST(SkeletonHeaderTest, TheSkeletonOfSuchATierIsRequired) {
    expectSkeletonRefusal([](ModelBuilder& builder) { builder.header.erase("skeleton"); }, "a member \"skeleton\"");
    for (const char* key : {"order", "harmonics", "swing_harmonics", "rungs", "hidden", "parameters"}) {
        expectSkeletonRefusal([key](ModelBuilder& builder) { builder.header["skeleton"].erase(key); }, key);
    }
}

TEST(SkeletonHeaderTest, ASeedBankBesideASkeletonIsRefused) {
    expectSkeletonRefusal(
        [](ModelBuilder& builder) { builder.header["seed_bank"] = ModelBuilder().header["seed_bank"]; },
        "header key \"seed_bank\": expected no seed bank beside a skeleton: export the model again");
}

TEST(SkeletonHeaderTest, ATierWithoutASkeletonBesideOthersWithOneNeedsNoSeeds) {
    ModelBuilder builder = refinedModel();
    builder.header["tiers"].push_back(ModelBuilder().header["tiers"][0]);
    builder.blobs.push_back({"field", "onnx", {}, Bytes(10, std::byte{0x22})});
    builder.blobs.push_back({"level", "onnx", {}, Bytes(10, std::byte{0x33})});
    EXPECT_EQ(ModelFile::parse(builder.build()).header().tiers[2].kind, TierKind::flow);
}

TEST(SkeletonHeaderTest, OtherSizesThanTheFormatsAreRefused) {
    const auto expectValueRefusal = [](const char* key, const Json& value, const std::string& part) {
        expectSkeletonRefusal([&](ModelBuilder& builder) { builder.header["skeleton"][key] = value; }, part);
    };
    expectValueRefusal("order", 25, "\"skeleton.order\": expected an integer from 24 to 24");
    expectValueRefusal("harmonics", 5, "\"skeleton.harmonics\"");
    expectValueRefusal("swing_harmonics", 14, "\"skeleton.swing_harmonics\"");
    expectValueRefusal("rungs", {2.0, 2.6, 3.1, 3.5}, "\"skeleton.rungs\"");
    expectValueRefusal("rungs", {2.0, 2.6, 3.1, 3.5, 4.5}, "\"skeleton.rungs\": expected [2, 2.6, 3.1, 3.5, 4]");
    expectValueRefusal("hidden", 513, "\"skeleton.hidden\": expected an integer from 1 to 512");
    expectValueRefusal("parameters", -1, "\"skeleton.parameters\"");
}

TEST(SkeletonHeaderTest, TheTensorThatStandsForTheSkeletonIsRequired) {
    expectSkeletonRefusal(
        [](ModelBuilder& builder) {
            std::erase_if(builder.blobs, [](const auto& blob) { return blob.name == "skeleton.4.weight"; });
        },
        "a blob \"skeleton.4.weight\" of type \"float32\" and shape [rows, 24]");
}

TEST(SkeletonHeaderTest, ARefiningTierNeedsAGraph) {
    expectSkeletonRefusal([](ModelBuilder& builder) { builder.header["tiers"][1].erase("field"); }, "field");
    expectSkeletonRefusal([](ModelBuilder& builder) { builder.header["tiers"][1]["field"] = "embedding"; },
                          "tiers[1].field");
}

TEST(SkeletonHeaderTest, TheSpaceNamesTheSkeletonByItsTensorAndOthersByTheirGraph) {
    const ModelFile model = ModelFile::parse(refinedModel().build());
    const auto crcOf = [&](std::string_view name) { return hexadecimal(model.findBlob(name)->crc32); };
    const std::string text = "sketch:" + crcOf("skeleton.4.weight") + ";standard:" + crcOf("standard.field") + ';';
    EXPECT_EQ(spaceOf(model.header()), hexadecimal(crc32(std::as_bytes(std::span(text)))));
}

TEST(SkeletonHeaderTest, TensorsAreReadByName) {
    const ModelFile model = ModelFile::parse(refinedModel().build());
    EXPECT_EQ(model.tensor("skeleton.4.bias").size(), 269U);
    EXPECT_EQ(model.findBlob("skeleton.4.bias")->shape, (std::vector<std::int64_t>{269}));
    EXPECT_EQ(model.findBlob("skeleton.5.bias"), nullptr);
    EXPECT_THROW((void)model.tensor("skeleton.5.bias"), std::out_of_range);
}

TEST(LabelTest, StickSlipAndTheWanderOfRibsAreReadAndMissingOnesAreEmpty) {
    ModelBuilder builder;
    builder.header["labels"][0]["stick_slip"] = {{"length_metres", 0.0011}, {"wander", 0.25}, {"wander_metres", 0.004}};
    builder.header["labels"][1]["rib_wander"] = {{{"turns", 0.12}, {"wavelength_metres", 0.00875}},
                                                 {{"turns", 0.0}, {"wavelength_metres", 0.014}}};
    const ModelFile model = ModelFile::parse(builder.build());
    const Label& slipping = model.header().labels[0];
    ASSERT_TRUE(slipping.stickSlip);
    EXPECT_EQ(slipping.stickSlip->lengthMetres, 0.0011);
    EXPECT_EQ(slipping.stickSlip->wander, 0.25);
    EXPECT_EQ(slipping.stickSlip->wanderMetres, 0.004);
    EXPECT_TRUE(slipping.ribWander.empty());
    const Label& ruled = model.header().labels[1];
    EXPECT_FALSE(ruled.stickSlip);
    ASSERT_EQ(ruled.ribWander.size(), 2U);
    EXPECT_EQ(ruled.ribWander[0].cycles, 0.12);
    EXPECT_EQ(ruled.ribWander[1].wavelengthMetres, 0.014);
}

TEST(LabelTest, StickSlipAndTheWanderOfRibsOutOfRangeAreRefused) {
    const auto expectLabelRefusal = [](const char* key, const Json& value, const std::string& part) {
        expectHeaderRefusal([&](Json& header) { header["labels"][0][key] = value; }, part);
    };
    const Json slip{{"length_metres", 0.0011}, {"wander", 0.25}, {"wander_metres", 0.004}};
    for (const char* key : {"length_metres", "wander", "wander_metres"}) {
        Json changed = slip;
        changed[key] = -1.0;
        expectLabelRefusal("stick_slip", changed, std::string("labels[0].stick_slip.") + key);
        changed.erase(key);
        expectLabelRefusal("stick_slip", changed, key);
    }
    expectLabelRefusal("rib_wander", Json::array(), "labels[0].rib_wander");
    const Json wander{{"turns", 0.1}, {"wavelength_metres", 0.01}};
    expectHeaderRefusal(
        [&](Json& header) {
            header["labels"][0]["rib_wander"] = {wander, wander, wander};
        },
        "labels[0].rib_wander", ModelStatus::oversized);
    expectLabelRefusal("rib_wander", {{{"turns", -0.1}, {"wavelength_metres", 0.01}}}, "labels[0].rib_wander[0].turns");
    expectLabelRefusal("rib_wander", {{{"turns", 0.1}, {"wavelength_metres", 0.0}}},
                       "labels[0].rib_wander[0].wavelength_metres");
}

}  // namespace
}  // namespace haptoflow::model::testing
