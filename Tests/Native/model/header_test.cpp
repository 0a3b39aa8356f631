#include "refusal.hpp"

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

}  // namespace
}  // namespace haptoflow::model::testing
