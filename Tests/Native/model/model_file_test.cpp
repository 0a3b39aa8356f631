#include "model/model_file.hpp"

#include "model/file_layout.hpp"
#include "refusal.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>

namespace haptoflow::model::testing {
namespace {

TEST(ModelFileTest, EveryValueOfAValidModelIsRead) {
    const ModelFile model = ModelFile::parse(ModelBuilder().build());
    const ModelHeader& header = model.header();

    EXPECT_EQ(header.name, "test model");
    EXPECT_EQ(header.description, "Made by the tests.");
    EXPECT_EQ(header.provenance.statement, "trained on nothing");
    EXPECT_EQ(header.provenance.created, "2025-01-31");
    EXPECT_DOUBLE_EQ(header.peakMps2, 25.0);
    EXPECT_DOUBLE_EQ(header.speedMps.minimum, 0.01);
    EXPECT_DOUBLE_EQ(header.forceNewtons.maximum, 4.0);
    EXPECT_DOUBLE_EQ(header.speedMps.percentiles[2], 0.1);
    EXPECT_DOUBLE_EQ(header.forceNewtons.percentiles[4], 3.0);

    ASSERT_EQ(header.labels.size(), 2U);
    EXPECT_EQ(header.labels[1].name, "metal mesh");
    EXPECT_EQ(header.labels[1].embeddingRow, 1U);
    EXPECT_EQ(header.labels[1].wavelengthMetres, 0.002);
    EXPECT_EQ(header.labels[0].wavelengthMetres, std::nullopt);
    EXPECT_DOUBLE_EQ(header.labels[0].speedLevelExponent, 0.5);
    EXPECT_DOUBLE_EQ(header.labels[0].forceLevelExponent, 0.25);
    EXPECT_DOUBLE_EQ(header.labels[0].stiffnessNewtonsPerMetre, 800.0);

    ASSERT_EQ(header.tiers.size(), 2U);
    EXPECT_EQ(header.tiers[header.defaultTier].name, "standard");
    EXPECT_EQ(header.tiers[1].solver, SolverKind::midpoint);
    EXPECT_EQ(header.tiers[1].steps, 2);
    EXPECT_EQ(header.tiers[0].parameters, 12345);
    EXPECT_EQ(header.tiers[0].accuracyJson, R"({"spectral_error_db":1.5})");
    EXPECT_EQ(header.tiers[0].costJson, "{}");

    ASSERT_EQ(header.seeds.size(), 3U);
    EXPECT_EQ(header.seeds[2].label, 1U);
    EXPECT_DOUBLE_EQ(header.seeds[1].velocityMps[0], 0.2);
    EXPECT_DOUBLE_EQ(header.seeds[1].forceNewtons, 2.0);
}

TEST(ModelFileTest, ALabelsEmbeddingIsTheRowThatItNames) {
    ModelBuilder builder;
    builder.header["labels"][0]["embedding_row"] = 1;
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_FLOAT_EQ(model.embedding(0)[0], 0.64F);
    EXPECT_FLOAT_EQ(model.embedding(0)[63], 1.27F);
    EXPECT_THROW((void)model.embedding(2), std::out_of_range);
}

TEST(ModelFileTest, TheOffsetsOfRecordedPiecesAreThoseOfTheRowThatALabelNames) {
    EXPECT_TRUE(ModelFile::parse(ModelBuilder().build()).pieceOffsets(1).empty());
    ModelBuilder builder;
    builder.header["labels"][0]["embedding_row"] = 1;
    std::vector<float> offsets(2 * 3 * textureSize);
    offsets[3 * textureSize] = 0.25F;
    offsets.back() = -0.5F;
    builder.blobs.push_back({"pieces", "float32", {2, 3, 60}, bytesOf(offsets)});
    const ModelFile model = ModelFile::parse(builder.build());
    ASSERT_EQ(model.pieceOffsets(0).size(), 3 * textureSize);
    EXPECT_EQ(model.pieceOffsets(0).front(), 0.25F);
    EXPECT_EQ(model.pieceOffsets(0).back(), -0.5F);
    EXPECT_THROW((void)model.pieceOffsets(2), std::out_of_range);
}

TEST(ModelFileTest, SeedsAreReturnedRowByRow) {
    ModelBuilder builder;
    std::vector<float> seeds(3 * seedSamples, 1.0F);
    seeds[seedSamples] = -1.0F;
    builder.blobs[1].bytes = bytesOf(seeds);
    const ModelFile model = ModelFile::parse(builder.build());
    EXPECT_EQ(model.seed(0)[0], 1.0F);
    EXPECT_EQ(model.seed(1)[0], -1.0F);
    EXPECT_EQ(model.seed(1)[1], 1.0F);
    EXPECT_THROW((void)model.seed(3), std::out_of_range);
}

TEST(ModelFileTest, BlobsAndTiersAreFoundByName) {
    const ModelFile model = ModelFile::parse(ModelBuilder().build());
    EXPECT_EQ(model.blob("field").size(), 100U);
    EXPECT_EQ(model.blob("field")[99], std::byte{0x5A});
    EXPECT_EQ(model.blob("level").size(), 37U);
    EXPECT_THROW((void)model.blob("nothing"), std::out_of_range);
    ASSERT_NE(model.findTier("draft"), nullptr);
    EXPECT_EQ(model.findTier("draft")->steps, 1);
    EXPECT_EQ(model.findTier("fine"), nullptr);
}

TEST(ModelFileTest, AModelStaysValidWhenItIsMoved) {
    ModelFile first = ModelFile::parse(ModelBuilder().build());
    const ModelFile second = std::move(first);
    EXPECT_EQ(second.blob("field")[0], std::byte{0x5A});
    EXPECT_EQ(second.header().labels.size(), 2U);
    EXPECT_FLOAT_EQ(second.embedding(1)[0], 0.64F);
}

TEST(ModelFileTest, TheHeaderTextHasNoPadding) {
    const ModelFile model = ModelFile::parse(ModelBuilder().build());
    EXPECT_EQ(model.headerText().front(), '{');
    EXPECT_EQ(model.headerText().back(), '}');
    EXPECT_EQ(nlohmann::json::parse(model.headerText())["name"], "test model");
}

/// The path of a file of these bytes, made longer by a hole if `bytes` is above their number.
std::filesystem::path written(const Bytes& content, std::uintmax_t bytes = 0) {
    const std::filesystem::path path =
        ::testing::TempDir() + "haptoflow_" + std::to_string(::testing::UnitTest::GetInstance()->start_timestamp());
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
    std::filesystem::resize_file(path, std::max<std::uintmax_t>(bytes, content.size()));
    return path;
}

TEST(ModelFileTest, TheErrorForAFileThatCannotBeReadNamesItsPathAndKeepsItsStatus) {
    const auto refuse = [](const std::filesystem::path& path, ModelStatus status) {
        try {
            (void)ModelFile::read(path);
            ADD_FAILURE() << path << " was read";
        } catch (const ModelError& error) {
            EXPECT_EQ(error.status(), status) << path;
            EXPECT_THAT(error.what(), ::testing::StartsWith(path.string()));
        }
    };
    refuse("/no/such/model.haptoflow", ModelStatus::unreadable);
    refuse(::testing::TempDir(), ModelStatus::unreadable);
    Bytes damaged = ModelBuilder().build();
    damaged[50] ^= std::byte{2};
    refuse(written(damaged), ModelStatus::damaged);
    const std::filesystem::path huge = written({}, 268'435'457);
    refuse(huge, ModelStatus::oversized);
    std::filesystem::remove(huge);
}

TEST(ModelFileTest, AFileWrittenByPythonIsRead) {
    const std::filesystem::path path = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";
    const ModelFile model = ModelFile::read(path);
    const Bytes bytes = readFile(path, maximumFileBytes);
    EXPECT_EQ(model.byteCount(), bytes.size());
    EXPECT_EQ(model.checksum(), crc32(bytes));
    EXPECT_EQ(model.header().name, "tiny");
    ASSERT_EQ(model.header().labels.size(), 2U);
    EXPECT_EQ(model.header().labels[1].name, "ruled");
    EXPECT_EQ(model.header().labels[1].wavelengthMetres, 0.001);
    // Row r, column c of the embedding holds sin(r + 0.1 c); see make_tiny_model.py.
    EXPECT_NEAR(model.embedding(1)[10], std::sin(2.0), 1e-7);
    EXPECT_NEAR(model.seed(0)[1], std::sqrt(2.0) * std::sin(2.0 * 3.14159265358979 * 20.0 / 400.0), 1e-6);
}

}  // namespace
}  // namespace haptoflow::model::testing
