#include "refusal.hpp"

#include "../inference/skeleton_model.hpp"
#include "model/file_layout.hpp"
#include "model/plain_text.hpp"

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

TEST(HeaderTest, AMissingKeyIsRefusedByName) {
    const std::vector<std::pair<std::string, std::vector<const char*>>> required{
        {"",
         {"name", "description", "provenance", "sample_rate_hz", "segment_samples", "normalisation", "range",
          "embedding_size", "labels", "tiers", "default_tier"}},
        {"/provenance", {"statement", "recordings", "licence", "seed", "commit", "configuration", "created"}},
        {"/seed_bank", {"samples", "tensor", "entries"}},
        {"/labels/1",
         {"name", "embedding_row", "level_exponents", "frequency_exponent", "periodic", "wavelength_metres",
          "stiffness_newtons_per_metre", "friction_coefficient", "category"}},
        {"/tiers/0",
         {"name", "kind", "field", "level", "solver", "steps", "parameters", "representation", "accuracy", "cost"}}};
    for (const auto& [place, keys] : required) {
        for (const char* key : keys) {
            expectHeaderRefusal([&](Json& header) { header[Json::json_pointer(place)].erase(key); },
                                "expected a member \"" + std::string(key) + '"');
        }
    }
}

TEST(HeaderTest, UnknownKeysAreIgnored) {
    ModelBuilder builder;
    builder.header["written_later"] = {1, 2, 3};
    builder.header["labels"][0]["smell"] = "pine";
    EXPECT_NO_THROW((void)ModelFile::parse(builder.build()));
}

TEST(HeaderTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal("/name", "", "not empty");
    expectHeaderRefusal("/name", 3, "\"name\": expected a string");
    expectHeaderRefusal("/description", "a\u001b[2Jb", "control characters");
    expectHeaderRefusal("/name", std::string(129, 'a'), "the limit is 128", ModelStatus::oversized);
    expectHeaderRefusal("/provenance/statement", "", "provenance.statement");
    expectHeaderRefusal("/provenance/seed", 1.5, "provenance.seed");
    expectHeaderRefusal("/provenance/seed", UINT64_MAX, "provenance.seed");
    expectHeaderRefusal("/sample_rate_hz", 4000, "sample_rate_hz");
    expectHeaderRefusal("/segment_samples", 199, "segment_samples");
    expectHeaderRefusal("/embedding_size", 32, "embedding_size");
    expectHeaderRefusal("/normalisation/unit", "g", "m/s^2");
    expectHeaderRefusal("/normalisation/peak_mps2", 0, "peak_mps2");
    expectHeaderRefusal("/range/speed_mps", {0.2, 0.2}, "range.speed_mps");
    expectHeaderRefusal("/range/force_newtons", {3.0, 1.0}, "range.force_newtons");
    expectHeaderRefusal("/range/speed_mps", {-0.1, 0.2}, "range.speed_mps[0]");
    expectHeaderRefusal("/range/force_newtons", {0.1, 1e9}, "range.force_newtons[1]");
    expectHeaderRefusal("/range/speed_mps", {0.1, 0.2, 0.3}, "an array of 2 numbers");
    expectHeaderRefusal("/range/speed_percentiles_mps", {0.1, 0.05, 0.2, 0.3, 0.4}, "rising order");
    expectHeaderRefusal("/range/force_percentiles_newtons", {1, 2, 3, 4}, "force_percentiles_newtons");
    expectHeaderRefusal("/default_tier", "fine", "default_tier");
    expectHeaderRefusal("/measurements", 5, "measurements");
    expectHeaderRefusal([](Json& header) { header.erase("seed_bank"); },
                        "header: expected a member \"seed_bank\" or \"skeleton\", from which touches begin: export the "
                        "model again");
    expectHeaderRefusal("/seed_bank/samples", 200, "seed_bank.samples");
    expectHeaderRefusal("/seed_bank/entries/1/label", "felt", "seed_bank.entries[1].label");
    expectHeaderRefusal("/seed_bank/entries/0/velocity_mps", {0.0, 1e6}, "entries[0].velocity_mps[1]");
    expectHeaderRefusal("/seed_bank/entries/0/force_newtons", -1, "entries[0].force_newtons");
    expectHeaderRefusal("/seed_bank/entries/0/rib_phase", {0.5},
                        "\"seed_bank.entries[0].rib_phase\": expected an array of 2 numbers");
    expectHeaderRefusal("/seed_bank/entries/0/rib_phase", {0.5, 1.5},
                        "entries[0].rib_phase[1]\": expected a number from 0 to 1");
    expectHeaderRefusal("/seed_bank/entries/2/rib_phase", 0.5, "entries[2].rib_phase");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"].erase(2); }, "as many entries");
    expectHeaderRefusal("/seed_bank/tensor", "nothing", "\"nothing\"");
    expectHeaderRefusal("/seed_bank/tensor", "embedding", "[rows, 400]");
    expectHeaderRefusal("/seed_bank/entries", Json(Json::array_t(maximumSeeds + 1, Json(0))), "the limit is 65536",
                        ModelStatus::oversized);
}

TEST(HeaderTest, AnEmptyDateIsAcceptedAndAnInvalidOneRefused) {
    ModelBuilder builder;
    builder.header["provenance"]["created"] = "";
    EXPECT_NO_THROW((void)ModelFile::parse(builder.build()));
    for (const char* text : {"yesterday", "2025-13-01", "2025-1-1", "2025-01-32", "2025/01/01"}) {
        expectHeaderRefusal([text](Json& header) { header["provenance"]["created"] = text; }, "YYYY-MM-DD");
    }
}

TEST(HeaderTest, PhaseAndGainOfASeedAreReadAndMissingOnesAreZeroAndOne) {
    ModelBuilder builder;
    builder.header["seed_bank"]["entries"][1]["rib_phase"] = {0.25, 0.875};
    builder.header["seed_bank"]["entries"][1]["gain"] = 0.25;
    const std::vector<SeedEntry> seeds = ModelFile::parse(builder.build()).header().seeds;
    EXPECT_EQ(seeds[0].ribPhase, (std::array<double, 2>{0.0, 0.0}));
    EXPECT_EQ(seeds[1].ribPhase, (std::array<double, 2>{0.25, 0.875}));
    EXPECT_EQ(seeds[0].gain, 1.0F);
    EXPECT_EQ(seeds[1].gain, 0.25F);
    expectHeaderRefusal("/seed_bank/entries/0/gain", -1.0,
                        "seed_bank.entries[0].gain\": expected a number from 0 to 16");
}

void expectLabelRefusal(const char* key, const Json& value, const std::string& part) {
    expectHeaderRefusal([&](Json& header) { header["labels"][0][key] = value; }, part);
}

void expectTierRefusal(const char* key, const Json& value, const std::string& part) {
    expectHeaderRefusal([&](Json& header) { header["tiers"][1][key] = value; }, part);
}

TEST(LabelTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal("/labels", Json::array(), "labels");
    expectHeaderRefusal("/labels", Json(Json::array_t(maximumLabels + 1, Json(0))), "the limit is 4096",
                        ModelStatus::oversized);
    expectLabelRefusal("name", "metal mesh", "appears twice");
    expectLabelRefusal("name", "", "labels[0].name");
    expectLabelRefusal("name", "Oak", "lower case");
    expectLabelRefusal("embedding_row", 2, "labels[0].embedding_row");
    expectLabelRefusal("embedding_row", -1, "labels[0].embedding_row");
    expectLabelRefusal("embedding_row", 0.5, "labels[0].embedding_row");
    expectLabelRefusal("level_exponents", {{"speed", 5.0}, {"force", 0.0}}, "level_exponents.speed");
    expectLabelRefusal("level_exponents", {{"speed", 0.0}, {"force", -5.0}}, "level_exponents.force");
    expectLabelRefusal("frequency_exponent", -0.1, "frequency_exponent");
    expectLabelRefusal("periodic", true, "wavelength_metres");
    expectLabelRefusal("wavelength_metres", 0.001, "not periodic");
    expectHeaderRefusal("/labels/1/wavelength_metres", 0, "wavelength_metres");
    expectLabelRefusal("stiffness_newtons_per_metre", 0, "stiffness_newtons_per_metre");
    expectLabelRefusal("stiffness_newtons_per_metre", 1e7, "stiffness_newtons_per_metre");
    expectLabelRefusal("friction_coefficient", -0.1, "friction_coefficient");
    expectLabelRefusal("category", "", "labels[0].category");
}

Json oneMode() {
    return {{"frequency_hz", 180.0}, {"decay_per_second", 75.0}, {"gain_per_second", 170.0}};
}

TEST(LabelTest, TheImpactOfALabelIsReadAndAMissingOneIsEmpty) {
    ModelBuilder builder;
    Json second = oneMode();
    second["frequency_hz"] = 640.0;
    builder.header["labels"][0]["impact"] = {{"modes", {oneMode(), second}}, {"restitution", 0.25}};
    const ModelFile model = ModelFile::parse(builder.build());
    const std::optional<Impact>& impact = model.header().labels[0].impact;
    ASSERT_TRUE(impact);
    EXPECT_EQ(impact->modes[0].frequencyHz, 180.0);
    EXPECT_EQ(impact->modes[0].decayPerSecond, 75.0);
    EXPECT_EQ(impact->modes[0].gainPerSecond, 170.0);
    EXPECT_EQ(impact->modes[1].frequencyHz, 640.0);
    EXPECT_EQ(impact->restitution, 0.25);
    EXPECT_FALSE(model.header().labels[1].impact);
}

TEST(LabelTest, AnImpactOutOfRangeIsRefused) {
    const auto refused = [](const char* key, const Json& value, const char* named) {
        Json impact = {{"modes", Json::array({oneMode()})}, {"restitution", 0.2}};
        if (impact.contains(key)) {
            impact[key] = value;
        } else {
            impact["modes"][0][key] = value;
        }
        expectLabelRefusal("impact", impact, named);
    };
    refused("modes", Json::array(), "impact.modes");
    expectHeaderRefusal(
        [](Json& header) {
            const Json modes = Json::array({oneMode(), oneMode(), oneMode()});
            header["labels"][0]["impact"] = {{"modes", modes}, {"restitution", 0.2}};
        },
        "impact.modes", ModelStatus::oversized);
    refused("restitution", 0.95, "impact.restitution");
    refused("restitution", -0.1, "impact.restitution");
    refused("frequency_hz", 0.0, "frequency_hz");
    refused("frequency_hz", 1e9, "frequency_hz");
    refused("decay_per_second", 0.0, "decay_per_second");
    refused("gain_per_second", 1e30, "gain_per_second");
    expectLabelRefusal("impact", "hard", "impact");
    expectLabelRefusal("impact", Json::object(), "modes");
}

TEST(TierTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal("/tiers", Json::array(), "tiers");
    expectHeaderRefusal("/tiers", Json(Json::array_t(maximumTiers + 1, Json(0))), "the limit is 64",
                        ModelStatus::oversized);
    expectTierRefusal("name", "draft", "appears twice");
    expectTierRefusal("kind", "diffusion", "\"average-velocity\"");
    expectTierRefusal("solver", "rk45", "\"heun\"");
    expectTierRefusal("steps", 0, "tiers[1].steps");
    expectTierRefusal("steps", 17, "tiers[1].steps");
    expectTierRefusal("parameters", -1, "tiers[1].parameters");
    expectTierRefusal("field", "nothing", "tiers[1].field");
    expectTierRefusal("level", "nothing", "tiers[1].level");
    expectTierRefusal("field", "embedding", "type \"onnx\"");
    expectTierRefusal("accuracy", 0.5, "tiers[1].accuracy");
    expectTierRefusal("cost", Json::array(), "tiers[1].cost");
    expectTierRefusal("representation", "spectrum", "\"latent\"");
}

const Json latent{{"representation", "latent"}, {"latent_shape", {16, 8}}, {"encoder", "level"}, {"decoder", "field"}};

TEST(TierTest, ALatentTierIsReadAndHasAShapeAnEncoderAndADecoder) {
    ModelBuilder builder;
    builder.header["tiers"][1].update(latent);
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_EQ(model.header().tiers[1].latentShape, (std::vector<std::int64_t>{16, 8}));
    EXPECT_EQ(model.header().tiers[1].encoder, "level");
    EXPECT_EQ(model.header().tiers[1].decoder, "field");
    for (const char* key : {"latent_shape", "encoder", "decoder"}) {
        Json without = latent;
        without.erase(key);
        expectHeaderRefusal([&](Json& header) { header["tiers"][1].update(without); }, key);
    }
    for (const Json& shape : {Json::array(), Json::array({0}), Json::array({4096, 4096, 4096})}) {
        Json other = latent;
        other["latent_shape"] = shape;
        expectHeaderRefusal([&](Json& header) { header["tiers"][1].update(other); }, "latent_shape");
    }
}

/// The order of three tiers, the least accurate first, by their accuracy objects.
std::vector<std::size_t> orderOf(const std::array<Json, 3>& accuracies) {
    ModelBuilder builder;
    builder.header["tiers"].push_back(builder.header["tiers"][1]);
    builder.header["tiers"][2]["name"] = "fine";
    for (std::size_t tier = 0; tier < accuracies.size(); ++tier) {
        builder.header["tiers"][tier]["accuracy"] = accuracies[tier];
    }
    return tiersByAccuracy(ModelFile::parse(builder.build()).header().tiers);
}

Json measured(double spectralDistanceDb, double levelErrorDb) {
    return {{"lsd_db", spectralDistanceDb}, {"level_error_p90_db", levelErrorDb}, {"gfc_recording", 0.99}};
}

using Order = std::vector<std::size_t>;

TEST(TierAccuracyTest, TheSmallestSumOfSpectralDistanceAndLevelErrorIsTheMostAccurate) {
    EXPECT_EQ(orderOf({measured(3.0, 1.0), measured(2.0, 1.0), measured(1.0, 1.0)}), (Order{0, 1, 2}));
    EXPECT_EQ(orderOf({measured(1.26, 0.98), measured(1.195, 0.76), measured(1.1925, 1.01)}), (Order{0, 2, 1}))
        << "a negligibly better spectrum does not outweigh the level";
    EXPECT_EQ(orderOf({measured(1.0, 0.5), measured(1.0, 1.0), measured(2.0, 1.0)}), (Order{2, 1, 0}));
    EXPECT_EQ(orderOf({measured(1.0, 1.0), measured(1.0, 1.0), measured(3.0, 1.0)}), (Order{2, 0, 1}))
        << "equally accurate tiers keep the file's order";
}

TEST(TierAccuracyTest, AllTiersKeepTheFilesOrderIfOneWasNotMeasured) {
    const Json best = measured(1.0, 1.0);
    for (const Json& unknown :
         {Json::object(), Json{{"lsd_db", 2.0}}, Json{{"lsd_db", 2.0}, {"level_error_p90_db", "1"}},
          Json{{"lsd_db", nullptr}, {"level_error_p90_db", 1.0}}, measured(-1.0, 0.5)}) {
        EXPECT_EQ(orderOf({best, measured(2.0, 2.0), unknown}), (Order{0, 1, 2})) << unknown;
    }
}

// The keys of models whose tiers use a skeleton.

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
