#include "model/material_file.hpp"

#include "material_builder.hpp"
#include "model/material_tables.hpp"
#include "model/model_file.hpp"
#include "model/plain_text.hpp"
#include "model_builder.hpp"
#include "random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

const std::string goldenFolder = HAPTOFLOW_TEST_GOLDEN_DIR "/material/";

Json readJson(const std::string& path) {
    std::ifstream stream(path);
    return Json::parse(stream);
}

/// Expects that the material is refused with a message that contains `part`.
void expectRefusal(const Json& material, const std::string& part) {
    try {
        (void)parseMaterial(material.dump());
        ADD_FAILURE() << "accepted; expected a refusal that mentions: " << part;
    } catch (const MaterialError& error) {
        EXPECT_THAT(error.what(), HasSubstr(part));
    }
}

/// Expects the same for a valid material with one changed value.
void expectRefused(const std::string& pointer, const Json& value, const std::string& part) {
    Json material = validMaterial("0123abcd");
    material[Json::json_pointer(pointer)] = value;
    expectRefusal(material, part);
}

TEST(MaterialFileTest, EveryKeyOfAFileIsRead) {
    const MaterialFile material = parseMaterial(validMaterial("0123abcd").dump());
    EXPECT_EQ(material.space, "0123abcd");
    EXPECT_EQ(material.label.name, "denim");
    EXPECT_EQ(material.label.category, "cloth");
    EXPECT_EQ(material.description, "A pair of jeans.");
    EXPECT_EQ(material.provenance.licence, "unknown");
    EXPECT_EQ(material.provenance.seconds, 10.5);
    EXPECT_EQ(material.embedding[63], 0.5F);
    EXPECT_EQ(material.speedMps[1], 0.18);
    EXPECT_EQ(material.forceNewtons[0], 1.0);
    EXPECT_EQ(material.label.wavelengthMetres, 0.002);
    EXPECT_EQ(material.label.impact->modes[0].frequencyHz, 90.0);
    EXPECT_EQ(material.label.level->logLevels[1], 1.0);
    EXPECT_EQ(material.label.level->forceExponent, 0.5);
    EXPECT_EQ(material.label.tone->gainsDb[1][1], 12.0);
    EXPECT_EQ(material.label.levelOffsetDb, 3.0);
    ASSERT_EQ(material.seeds.size(), 1U);
    EXPECT_EQ(material.seeds[0].ribPhase[0], 0.25);
    EXPECT_NEAR(material.seeds[0].samples[5], std::sqrt(2.0), 1e-6);
}

TEST(MaterialFileTest, OptionalKeysMayBeMissingAndUnknownKeysAreIgnored) {
    Json json = validMaterial("0123abcd");
    for (const char* key : {"description", "impact", "level", "tone", "level_offset_db", "seeds"}) {
        json.erase(key);
    }
    json["colour"] = "indigo";
    const MaterialFile material = parseMaterial(json.dump());
    EXPECT_FALSE(material.label.level || material.label.tone || material.label.impact);
    EXPECT_EQ(material.label.levelOffsetDb, 0.0);
    EXPECT_TRUE(material.seeds.empty());
}

TEST(MaterialFileTest, AFileWithAMissingMandatoryKeyIsRefusedWithTheKey) {
    for (const char* key : {"format", "version", "space", "name", "category", "provenance", "embedding", "range",
                            "level_exponents", "frequency_exponent", "periodic", "wavelength_metres",
                            "stiffness_newtons_per_metre", "friction_coefficient"}) {
        Json material = validMaterial("0123abcd");
        material.erase(key);
        expectRefusal(material, std::string("\"") + key + '"');
    }
}

TEST(MaterialFileTest, AnInvalidValueIsRefusedWithItsKey) {
    expectRefused("/format", "haptoflow", "material key \"format\": expected \"haptoflow-material\"");
    expectRefused("/version", 2, "update HaptoFlow");
    expectRefused("/version", 0, "version");
    expectRefused("/space", "0123ABCD", "8 hexadecimal digits");
    expectRefused("/space", "0123abc", "space");
    expectRefused("/name", "", "name");
    expectRefused("/name", std::string(129, 'a'), "the limit is 128");
    expectRefused("/embedding", std::vector<double>(63, 0.0), "embedding");
    expectRefused("/embedding/7", 1e30, "embedding[7]");
    expectRefused("/embedding/7", "0", "embedding[7]");
    expectRefused("/range/speed_mps", Json{0.2, 0.1}, "range.speed_mps");
    expectRefused("/range/force_newtons", Json{0.2, 2000.0}, "range.force_newtons[1]");
    expectRefused("/provenance/seconds", -1.0, "provenance.seconds");
    expectRefused("/provenance/licence", "", "provenance.licence");
    expectRefused("/provenance/created", "2026-13-01", "provenance.created");
    expectRefused("/seeds/0/samples/3", 900.0, "seeds[0].samples");
    expectRefused("/seeds/0/samples", std::vector<double>(399, 1.0), "seeds[0].samples");
    expectRefused("/seeds/0/force_newtons", -1.0, "seeds[0].force_newtons");
    expectRefused("/seeds/0/rib_phase", Json{0.5}, "seeds[0].rib_phase");
    expectRefused("/seeds", Json(Json::array_t(17, validSeed())), "the limit is 16");
}

TEST(MaterialFileTest, AnInvalidLevelToneOrOffsetIsRefusedWithItsKeyAlsoInAModel) {
    const auto refused = [](const std::string& pointer, const Json& value, const std::string& part) {
        expectRefused(pointer, value, part);
        ModelBuilder builder;
        Json& label = builder.header["labels"][1];
        const Json material = validMaterial("0123abcd");
        for (const char* key : {"level", "tone", "level_offset_db"}) {
            label[key] = material[key];
        }
        EXPECT_TRUE(ModelFile::parse(builder.build()).header().labels[1].tone);
        label[Json::json_pointer(pointer)] = value;
        try {
            (void)ModelFile::parse(builder.build());
            ADD_FAILURE() << "the model was accepted; expected a refusal that mentions: " << part;
        } catch (const ModelError& error) {
            EXPECT_THAT(error.what(), HasSubstr("labels[1]." + part));
        }
    };
    refused("/level/speeds_mps", Json{0.1, 0.05, 0.2}, "level.speeds_mps[1]");
    refused("/level/speeds_mps", Json{0.1, 0.1, 0.2}, "level.speeds_mps[1]");
    refused("/level/speeds_mps", Json::array(), "level.speeds_mps");
    refused("/level/speeds_mps/0", -0.1, "level.speeds_mps[0]");
    refused("/level/log_levels", Json{0.0, 1.0}, "level.log_levels");
    refused("/level/log_levels/0", 21.0, "level.log_levels[0]");
    refused("/level/force_newtons", 0.005, "level.force_newtons");
    refused("/level/force_exponent", 5.0, "level.force_exponent");
    refused("/level", Json{1}, "level");
    refused("/tone/speeds_mps/0", 0.0, "tone.speeds_mps[0]");
    refused("/tone/frequencies_hz", Json{50.0}, "tone.frequencies_hz");
    refused("/tone/frequencies_hz/0", 9.0, "tone.frequencies_hz[0]");
    refused("/tone/frequencies_hz/1", 1001.0, "tone.frequencies_hz[1]");
    refused("/tone/gains_db", Json{{0.0, 0.0}}, "tone.gains_db");
    refused("/tone/gains_db/1/0", -31.0, "tone.gains_db[1][0]");
    refused("/tone/gains_db/0", Json{0.0, 0.0, 0.0}, "tone.gains_db[0]");
    // Two speeds at two forces need four rows.
    refused("/tone/forces_newtons", Json{0.5, 2.0}, "tone.gains_db");
    refused("/tone/forces_newtons", Json{2.0, 0.5}, "tone.forces_newtons");
    refused("/tone/forces_newtons", Json{0.0, 0.5}, "tone.forces_newtons[0]");
    refused("/tone/forces_newtons", Json::array(), "tone.forces_newtons");
    refused("/level_offset_db", 25.0, "level_offset_db");
    refused("/level_offset_db", nullptr, "level_offset_db");
    refused("/impulse_gain", 8.5, "impulse_gain");
    refused("/impulse_gain", -0.1, "impulse_gain");
    refused("/impulse_gain", "loud", "impulse_gain");
}

TEST(MaterialFileTest, AGainOnTheImpulsesIsReadAndIsOneWithoutTheKey) {
    Json material = validMaterial("0123abcd");
    EXPECT_EQ(parseMaterial(material.dump()).label.impulseGain, 1.0F);
    material["impulse_gain"] = 2.5;
    EXPECT_EQ(parseMaterial(material.dump()).label.impulseGain, 2.5F);
}

TEST(MaterialFileTest, EveryErrorOfTheGoldenFilesNamesItsKey) {
    const Json golden = readJson(goldenFolder + "invalid.json");
    const Json whole = readJson(goldenFolder + golden.at("of").get<std::string>());
    EXPECT_NO_THROW((void)parseMaterial(whole.dump()));
    ASSERT_GT(golden.at("cases").size(), 20U);
    for (const Json& each : golden.at("cases")) {
        const auto key = each.at("key").get<std::string>();
        SCOPED_TRACE(each.at("name").get<std::string>());
        // The message for a missing member names the member, not the object's path.
        expectRefusal(whole.patch(each.at("patch")), key.substr(key.rfind('.') + 1));
    }
}

TEST(MaterialFileTest, TheGoldenFilesAreReadAndTheirSpacesEqualThoseOfTheirModels) {
    const Json golden = readJson(goldenFolder + "expected.json");
    const ModelFile tiny = ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    const ModelFile shipped = ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    EXPECT_EQ(spaceOf(tiny.header()), golden.at("spaces").at("tiny").get<std::string>());
    EXPECT_EQ(spaceOf(shipped.header()), golden.at("spaces").at("default").get<std::string>());
    for (const auto& [name, expected] : golden.at("materials").items()) {
        const MaterialFile material = readMaterial(goldenFolder + name + ".haptomaterial");
        EXPECT_EQ(material.label.name, expected.at("name").get<std::string>());
        EXPECT_EQ(material.space, expected.at("space").get<std::string>());
    }
}

TEST(MaterialFileTest, AMaterialOfAnotherSpaceIsRefusedWithBothSpaces) {
    const ModelFile model = ModelFile::parse(ModelBuilder{}.build());
    const MaterialFile material = parseMaterial(validMaterial("0123abcd").dump());
    try {
        requireSpace(material, model.header());
        ADD_FAILURE() << "accepted";
    } catch (const MaterialMismatch& error) {
        EXPECT_THAT(error.what(), HasSubstr("0123abcd"));
        EXPECT_THAT(error.what(), HasSubstr(spaceOf(model.header())));
        EXPECT_THAT(error.what(), HasSubstr("learn the material again"));
    }
}

TEST(MaterialFileTest, ATextAboveTheLimitIsRefusedBeforeItIsRead) {
    const std::string longText(maximumMaterialBytes + 1, '[');
    try {
        (void)parseMaterial(longText);
        ADD_FAILURE() << "accepted";
    } catch (const MaterialError& error) {
        EXPECT_THAT(error.what(), HasSubstr("the limit is 1048576"));
    }
}

TEST(MaterialFileTest, AMissingFileAndAFolderAreRefusedWithTheirPath) {
    const auto refusal = [](const std::string& path) -> std::string {
        try {
            (void)readMaterial(path);
        } catch (const MaterialError& error) {
            return error.what();
        }
        return "accepted";
    };
    EXPECT_THAT(refusal("/no/such/denim.haptomaterial"), HasSubstr("/no/such/denim.haptomaterial: there is no such"));
    EXPECT_THAT(refusal(std::filesystem::temp_directory_path().string()), HasSubstr("there is no such file"));
    EXPECT_THAT(refusal(HAPTOFLOW_TEST_DEFAULT_MODEL), HasSubstr("default.haptoflow: the file has"));
    EXPECT_THAT(refusal(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow"), HasSubstr("is not valid JSON"));
}

// Under the sanitizers these tests show that invalid bytes cause no undefined behaviour.

TEST(MaterialMutationTest, AFileCutAtAnyLengthIsRefused) {
    const std::string text = validMaterial("0123abcd").dump();
    for (std::size_t length = 0; length < text.size(); length += 7) {
        EXPECT_THROW((void)parseMaterial(std::string_view(text).substr(0, length)), MaterialError) << length;
    }
}

TEST(MaterialMutationTest, AFileWithChangedBytesIsRefusedOrReadable) {
    const std::string text = validMaterial("0123abcd").dump();
    Random random(17);
    int accepted = 0;
    int refused = 0;
    for (int mutant = 0; mutant < 1000; ++mutant) {
        std::string changed = text;
        const std::size_t changes = 1 + random.below(3);
        for (std::size_t change = 0; change < changes; ++change) {
            changed[random.below(changed.size())] = static_cast<char>(random.below(256));
        }
        try {
            const MaterialFile material = parseMaterial(changed);
            EXPECT_FALSE(material.label.name.empty());
            for (const float value : material.embedding) {
                EXPECT_TRUE(std::isfinite(value));
            }
            ++accepted;
        } catch (const MaterialError& error) {
            EXPECT_STRNE(error.what(), "");
            ++refused;
        }
    }
    EXPECT_GT(accepted, 5);
    EXPECT_GT(refused, 100);
}

TEST(MaterialMutationTest, DeepNestingAndRepeatedKeysAreRefused) {
    Json material = validMaterial("0123abcd");
    material["nest"] = Json::parse(std::string(31, '[') + std::string(31, ']'));
    EXPECT_NO_THROW((void)parseMaterial(material.dump()));
    material["nest"] = Json::parse(std::string(32, '[') + std::string(32, ']'));
    expectRefusal(material, "the material nests deeper than 32 levels");
    EXPECT_THROW((void)parseMaterial(R"({"format": "haptoflow-material", "format": "haptoflow-material"})"),
                 MaterialError);
}

TEST(MaterialTablesTest, APlaceIsInterpolatedOverLogarithmsAndLimitedToTheEnds) {
    const double rising[]{0.01, 0.1, 0.4};
    for (const double value : {-1.0, 0.0, 0.005, 0.01, std::nan("")}) {
        EXPECT_EQ(placeInLog(rising, value).lower, 0U) << value;
        EXPECT_EQ(placeInLog(rising, value).share, 0.0) << value;
    }
    EXPECT_EQ(placeInLog(rising, 0.1).lower, 1U);
    EXPECT_EQ(placeInLog(rising, 0.1).share, 0.0);
    EXPECT_EQ(placeInLog(rising, 0.2).lower, 1U);
    EXPECT_NEAR(placeInLog(rising, 0.2).share, 0.5, 1e-12);
    for (const double value : {0.4, 7.0}) {
        EXPECT_EQ(placeInLog(rising, value).lower, 2U);
        EXPECT_EQ(placeInLog(rising, value).share, 0.0);
    }
}

TEST(MaterialTablesTest, ALevelFollowsTheTableAndPowerLawsBeyondItsSpeedsAndOverForce) {
    const LevelTable table{
        .speedsMps = {0.05, 0.2}, .logLevels = {1.0, 2.0}, .forceNewtons = 0.5, .forceExponent = 0.4};
    EXPECT_DOUBLE_EQ(table.logLevel(0.05, 0.5, 0.9), 1.0);
    EXPECT_DOUBLE_EQ(table.logLevel(0.2, 0.5, 0.9), 2.0);
    const double between = std::sqrt(0.0505 * 0.2005) - 0.0005;
    EXPECT_NEAR(table.logLevel(between, 0.5, 0.9), 1.5, 1e-12);
    EXPECT_NEAR(table.logLevel(0.4, 0.5, 0.9), 2.0 + 0.9 * std::log(0.4005 / 0.2005), 1e-12);
    EXPECT_NEAR(table.logLevel(0.0, 0.5, 0.9), 1.0 + 0.9 * std::log(0.0005 / 0.0505), 1e-12);
    EXPECT_NEAR(table.logLevel(0.05, 1.0, 0.9), 1.0 + 0.4 * std::log(2.0), 1e-12);
    EXPECT_DOUBLE_EQ(table.logLevel(0.05, 0.0, 0.9), table.logLevel(0.05, 0.02, 0.9));
    const LevelTable one{.speedsMps = {0.1}, .logLevels = {-1.0}, .forceNewtons = 1.0, .forceExponent = 0.0};
    EXPECT_DOUBLE_EQ(one.logLevel(0.1, 3.0, 1.0), -1.0);
    EXPECT_NEAR(one.logLevel(0.2, 3.0, 1.0), -1.0 + std::log(0.2005 / 0.1005), 1e-12);
    EXPECT_NEAR(one.logLevel(0.02, 3.0, 1.0), -1.0 + std::log(0.0205 / 0.1005), 1e-12);
}

TEST(MaterialTablesTest, AToneIsInterpolatedInDecibelsBetweenFourGains) {
    const ToneTable tone{
        .speedsMps = {0.05, 0.2}, .frequenciesHz = {50.0, 200.0, 800.0}, .gainsDb = {{0.0, 4.0, 6.0}, {2.0, 8.0, 0.0}}};
    EXPECT_DOUBLE_EQ(tone.gainDb(0.05, 1.0, 200.0), 4.0);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 200.0), 6.0, 1e-12);
    EXPECT_NEAR(tone.gainDb(0.05, 1.0, 100.0), 2.0, 1e-12);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 400.0), 0.5 * (5.0 + 4.0), 1e-12);
    EXPECT_NEAR(tone.rowGainDb(1, 400.0), 4.0, 1e-12);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.0, 1.0, 0.0), 0.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(9.0, 1.0, 1000.0), 0.0);
}

TEST(MaterialTablesTest, AToneOverForceIsInterpolatedBetweenRowsOfBothForces) {
    const ToneTable tone{.speedsMps = {0.05, 0.2},
                         .forcesNewtons = {0.5, 2.0},
                         .frequenciesHz = {50.0, 800.0},
                         .gainsDb = {{0.0, 0.0}, {2.0, 2.0}, {4.0, 4.0}, {10.0, 10.0}}};
    EXPECT_DOUBLE_EQ(tone.gainDb(0.2, 0.5, 100.0), 2.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.05, 2.0, 100.0), 4.0);
    EXPECT_NEAR(tone.gainDb(0.1, 1.0, 100.0), 0.25 * (0.0 + 2.0 + 4.0 + 10.0), 1e-12);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.001, 0.0, 100.0), 0.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(9.0, 90.0, 100.0), 10.0);
}

TEST(LabelKeyTest, SpellingsOfOneLabelAreTheSameAndThoseOfTwoAreNotByTheGoldenFile) {
    const nlohmann::json groups = nlohmann::json::parse(std::ifstream(HAPTOFLOW_TEST_GOLDEN_DIR "/labels/labels.json"));
    ASSERT_GT(groups.size(), 20U);
    std::vector<std::string> keys;
    for (const nlohmann::json& group : groups) {
        const std::string key = labelKey(group.at(0).get<std::string>());
        for (const nlohmann::json& spelling : group) {
            EXPECT_EQ(labelKey(spelling.get<std::string>()), key) << spelling;
        }
        for (const std::string& other : keys) {
            EXPECT_NE(other, key) << group;
        }
        keys.push_back(key);
    }
}

TEST(LabelKeyTest, BytesThatAreNotTextStayAsTheyAre) {
    EXPECT_EQ(labelKey("w\xE4"), "w\xE4");
    EXPECT_EQ(labelKey(""), "");
    EXPECT_EQ(labelKey("Metal-mesh_2"), "METAL-MESH_2");
}

}  // namespace
}  // namespace haptoflow::model::testing
