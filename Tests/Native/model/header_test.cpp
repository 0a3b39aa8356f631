#include "refusal.hpp"

#include <array>
#include <vector>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

TEST(HeaderTest, AHeaderWithAMissingKeyIsRefused) {
    for (const char* key : {"name", "description", "provenance", "sample_rate_hz", "segment_samples", "normalisation",
                            "range", "embedding_size", "labels", "tiers", "default_tier"}) {
        expectHeaderRefusal([key](Json& header) { header.erase(key); }, '"' + std::string(key) + '"');
    }
}

TEST(HeaderTest, ProvenanceWithAMissingKeyIsRefused) {
    for (const char* key : {"statement", "recordings", "licence", "seed", "commit", "configuration", "created"}) {
        expectHeaderRefusal([key](Json& header) { header["provenance"].erase(key); }, key);
    }
}

TEST(HeaderTest, UnknownKeysAreIgnored) {
    ModelBuilder builder;
    builder.header["written_later"] = {1, 2, 3};
    builder.header["labels"][0]["smell"] = "pine";
    EXPECT_NO_THROW((void)ModelFile::parse(builder.build()));
}

TEST(HeaderTest, InvalidValuesAreRefusedByKey) {
    expectHeaderRefusal([](Json& header) { header["name"] = ""; }, "not empty");
    expectHeaderRefusal([](Json& header) { header["name"] = 3; }, "\"name\": expected a string");
    expectHeaderRefusal([](Json& header) { header["description"] = "a\u001b[2Jb"; }, "control characters");
    expectHeaderRefusal([](Json& header) { header["name"] = std::string(129, 'a'); }, "the limit is 128",
                        ModelStatus::oversized);
    expectHeaderRefusal([](Json& header) { header["provenance"]["statement"] = ""; }, "provenance.statement");
    expectHeaderRefusal([](Json& header) { header["provenance"]["seed"] = 1.5; }, "provenance.seed");
    expectHeaderRefusal([](Json& header) { header["provenance"]["seed"] = UINT64_MAX; }, "provenance.seed");
    expectHeaderRefusal([](Json& header) { header["sample_rate_hz"] = 4000; }, "sample_rate_hz");
    expectHeaderRefusal([](Json& header) { header["segment_samples"] = 199; }, "segment_samples");
    expectHeaderRefusal([](Json& header) { header["embedding_size"] = 32; }, "embedding_size");
    expectHeaderRefusal([](Json& header) { header["normalisation"]["unit"] = "g"; }, "m/s^2");
    expectHeaderRefusal([](Json& header) { header["normalisation"]["peak_mps2"] = 0; }, "peak_mps2");
    expectHeaderRefusal([](Json& header) { header["range"]["speed_mps"] = {0.2, 0.2}; }, "range.speed_mps");
    expectHeaderRefusal([](Json& header) { header["range"]["force_newtons"] = {3.0, 1.0}; }, "range.force_newtons");
    expectHeaderRefusal([](Json& header) { header["range"]["speed_mps"] = {-0.1, 0.2}; }, "range.speed_mps[0]");
    expectHeaderRefusal([](Json& header) { header["range"]["force_newtons"] = {0.1, 1e9}; }, "range.force_newtons[1]");
    expectHeaderRefusal([](Json& header) { header["range"]["speed_mps"] = {0.1, 0.2, 0.3}; }, "an array of 2 numbers");
    expectHeaderRefusal(
        [](Json& header) {
            header["range"]["speed_percentiles_mps"] = {0.1, 0.05, 0.2, 0.3, 0.4};
        },
        "rising order");
    expectHeaderRefusal(
        [](Json& header) {
            header["range"]["force_percentiles_newtons"] = {1, 2, 3, 4};
        },
        "force_percentiles_newtons");
    expectHeaderRefusal([](Json& header) { header["default_tier"] = "fine"; }, "default_tier");
    expectHeaderRefusal([](Json& header) { header["measurements"] = 5; }, "measurements");
    expectHeaderRefusal([](Json& header) { header.erase("seed_bank"); },
                        "header: expected a member \"seed_bank\" or \"skeleton\", from which touches begin: export the "
                        "model again");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["samples"] = 200; }, "seed_bank.samples");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"][1]["label"] = "felt"; },
                        "seed_bank.entries[1].label");
    expectHeaderRefusal(
        [](Json& header) {
            header["seed_bank"]["entries"][0]["velocity_mps"] = {0.0, 1e6};
        },
        "entries[0].velocity_mps[1]");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"][0]["force_newtons"] = -1; },
                        "entries[0].force_newtons");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"][0]["rib_phase"] = {0.5}; },
                        "\"seed_bank.entries[0].rib_phase\": expected an array of 2 numbers");
    expectHeaderRefusal(
        [](Json& header) {
            header["seed_bank"]["entries"][0]["rib_phase"] = {0.5, 1.5};
        },
        "entries[0].rib_phase[1]\": expected a number from 0 to 1");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"][2]["rib_phase"] = 0.5; },
                        "entries[2].rib_phase");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"].erase(2); }, "as many entries");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["tensor"] = "nothing"; }, "\"nothing\"");
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["tensor"] = "embedding"; }, "[rows, 400]");
    expectHeaderRefusal(
        [](Json& header) { header["seed_bank"]["entries"] = Json(Json::array_t(maximumSeeds + 1, Json(0))); },
        "the limit is 65536", ModelStatus::oversized);
}

TEST(HeaderTest, AnEmptyDateIsAcceptedAndAnInvalidOneRefused) {
    ModelBuilder builder;
    builder.header["provenance"]["created"] = "";
    EXPECT_NO_THROW((void)ModelFile::parse(builder.build()));
    for (const char* text : {"yesterday", "2025-13-01", "2025-1-1", "2025-01-32", "2025/01/01"}) {
        expectHeaderRefusal([text](Json& header) { header["provenance"]["created"] = text; }, "YYYY-MM-DD");
    }
}

TEST(HeaderTest, ASeedBankWithAMissingKeyIsRefused) {
    for (const char* key : {"samples", "tensor", "entries"}) {
        expectHeaderRefusal([key](Json& header) { header["seed_bank"].erase(key); },
                            "header key \"seed_bank\": expected a member \"" + std::string(key) + '"');
    }
}

TEST(HeaderTest, TheRibPhaseOfASeedIsReadAndAMissingOneIsZero) {
    ModelBuilder builder;
    builder.header["seed_bank"]["entries"][1]["rib_phase"] = {0.25, 0.875};
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_EQ(model.header().seeds[0].ribPhase, (std::array<double, 2>{0.0, 0.0}));
    EXPECT_EQ(model.header().seeds[1].ribPhase, (std::array<double, 2>{0.25, 0.875}));
}

TEST(HeaderTest, TheGainOfASeedIsReadAndAMissingOneIsOne) {
    ModelBuilder builder;
    builder.header["seed_bank"]["entries"][1]["gain"] = 0.25;
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_EQ(model.header().seeds[0].gain, 1.0F);
    EXPECT_EQ(model.header().seeds[1].gain, 0.25F);
    expectHeaderRefusal([](Json& header) { header["seed_bank"]["entries"][0]["gain"] = -1.0; },
                        "seed_bank.entries[0].gain\": expected a number from 0 to 16");
}

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
