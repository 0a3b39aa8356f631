#include "refusal.hpp"

#include <array>
#include <vector>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

void expectLabelRefusal(const char* key, const Json& value, const std::string& part) {
    expectHeaderRefusal([&](Json& header) { header["labels"][0][key] = value; }, part);
}

void expectTierRefusal(const char* key, const Json& value, const std::string& part) {
    expectHeaderRefusal([&](Json& header) { header["tiers"][1][key] = value; }, part);
}

TEST(LabelTest, ALabelWithAMissingKeyIsRefused) {
    for (const char* key : {"name", "embedding_row", "level_exponents", "frequency_exponent", "periodic",
                            "wavelength_metres", "stiffness_newtons_per_metre", "friction_coefficient", "category"}) {
        expectHeaderRefusal([key](Json& header) { header["labels"][1].erase(key); }, key);
    }
}

TEST(LabelTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal([](Json& header) { header["labels"] = Json::array(); }, "labels");
    expectHeaderRefusal([](Json& header) { header["labels"] = Json(Json::array_t(maximumLabels + 1, Json(0))); },
                        "the limit is 4096", ModelStatus::oversized);
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
    expectHeaderRefusal([](Json& header) { header["labels"][1]["wavelength_metres"] = 0; }, "wavelength_metres");
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

TEST(TierTest, ATierWithAMissingKeyIsRefused) {
    for (const char* key :
         {"name", "kind", "field", "level", "solver", "steps", "parameters", "representation", "accuracy", "cost"}) {
        expectHeaderRefusal([key](Json& header) { header["tiers"][0].erase(key); }, key);
    }
}

TEST(TierTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal([](Json& header) { header["tiers"] = Json::array(); }, "tiers");
    expectHeaderRefusal([](Json& header) { header["tiers"] = Json(Json::array_t(maximumTiers + 1, Json(0))); },
                        "the limit is 64", ModelStatus::oversized);
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

TEST(TierTest, ALatentTierIsRead) {
    ModelBuilder builder;
    Json& tier = builder.header["tiers"][1];
    tier["representation"] = "latent";
    tier["latent_shape"] = {16, 8};
    tier["encoder"] = "level";
    tier["decoder"] = "field";
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_EQ(model.header().tiers[1].latentShape, (std::vector<std::int64_t>{16, 8}));
    EXPECT_EQ(model.header().tiers[1].encoder, "level");
    EXPECT_EQ(model.header().tiers[1].decoder, "field");
}

TEST(TierTest, ALatentTierWithoutShapeEncoderOrDecoderIsRefused) {
    for (const char* key : {"latent_shape", "encoder", "decoder"}) {
        expectHeaderRefusal(
            [key](Json& header) {
                Json& tier = header["tiers"][1];
                tier["representation"] = "latent";
                tier["latent_shape"] = {16, 8};
                tier["encoder"] = "level";
                tier["decoder"] = "field";
                tier.erase(key);
            },
            key);
    }
}

TEST(TierTest, AnEmptyOrTooLargeLatentIsRefused) {
    for (const Json& shape : {Json::array(), Json::array({0}), Json::array({4096, 4096, 4096})}) {
        expectHeaderRefusal(
            [&shape](Json& header) {
                Json& tier = header["tiers"][1];
                tier["representation"] = "latent";
                tier["latent_shape"] = shape;
                tier["encoder"] = "level";
                tier["decoder"] = "field";
            },
            "latent_shape");
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

TEST(TierAccuracyTest, TheSmallestSumOfSpectralDistanceAndLevelErrorIsTheMostAccurate) {
    using Order = std::vector<std::size_t>;
    EXPECT_EQ(orderOf({measured(3.0, 1.0), measured(2.0, 1.0), measured(1.0, 1.0)}), (Order{0, 1, 2}));
    EXPECT_EQ(orderOf({measured(1.26, 0.98), measured(1.195, 0.76), measured(1.1925, 1.01)}), (Order{0, 2, 1}))
        << "a negligibly better spectrum does not outweigh the level";
    EXPECT_EQ(orderOf({measured(1.0, 0.5), measured(1.0, 1.0), measured(2.0, 1.0)}), (Order{2, 1, 0}));
}

TEST(TierAccuracyTest, EquallyAccurateTiersKeepTheFilesOrder) {
    using Order = std::vector<std::size_t>;
    EXPECT_EQ(orderOf({measured(1.0, 1.0), measured(1.0, 1.0), measured(3.0, 1.0)}), (Order{2, 0, 1}));
}

TEST(TierAccuracyTest, AllTiersKeepTheFilesOrderIfOneWasNotMeasured) {
    using Order = std::vector<std::size_t>;
    const Json best = measured(1.0, 1.0);
    for (const Json& unknown :
         {Json::object(), Json{{"lsd_db", 2.0}}, Json{{"lsd_db", 2.0}, {"level_error_p90_db", "1"}},
          Json{{"lsd_db", nullptr}, {"level_error_p90_db", 1.0}}, measured(-1.0, 0.5)}) {
        EXPECT_EQ(orderOf({best, measured(2.0, 2.0), unknown}), (Order{0, 1, 2})) << unknown;
    }
}

}  // namespace
}  // namespace haptoflow::model::testing
