#include "open_handles.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

namespace haptoflow::capi::testing {
namespace {

haptoflow_status openBytes(const void* bytes, std::size_t count, haptoflow_model** model) {
    const haptoflow_model_options options{sizeof(options), bytes, count, nullptr};
    return haptoflow_model_open(&options, model);
}

TEST(ModelApiTest, AModelOpenedFromBytesDoesNotNeedThemAfterwards) {
    auto bytes = tinyModelBytes();
    haptoflow_model* model = nullptr;
    ASSERT_EQ(openBytes(bytes.data(), bytes.size(), &model), HAPTOFLOW_OK) << message();
    std::fill(bytes.begin(), bytes.end(), '\0');
    const char* header = nullptr;
    ASSERT_EQ(haptoflow_model_header(model, &header), HAPTOFLOW_OK);
    EXPECT_EQ(nlohmann::json::parse(header)["name"], "tiny");
    EXPECT_EQ(haptoflow_model_close(&model), HAPTOFLOW_OK);
    EXPECT_EQ(model, nullptr);
}

TEST(ModelApiTest, EachKindOfInvalidFileHasItsOwnStatus) {
    const auto valid = tinyModelBytes();
    haptoflow_model* model = nullptr;

    auto changed = valid;
    changed[0] = 'X';
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_NOT_A_MODEL);
    EXPECT_EQ(openBytes(valid.data(), valid.size() - 1, &model), HAPTOFLOW_MODEL_TRUNCATED);
    changed = valid;
    changed[100] = static_cast<char>(changed[100] ^ 1);
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_MODEL_DAMAGED);
    EXPECT_THAT(message(), ::testing::HasSubstr("checksum at byte 24"));
    changed = valid;
    changed.push_back('\0');
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_MODEL_INCONSISTENT);
    EXPECT_EQ(openBytes(valid.data(), std::size_t{1} << 40U, &model), HAPTOFLOW_MODEL_OVERSIZED);
    EXPECT_EQ(model, nullptr);
}

TEST(ModelApiTest, TheErrorForAnUnreadablePathNamesIt) {
    const haptoflow_model_options options{sizeof(options), nullptr, 0, "/nowhere/a.haptoflow"};
    haptoflow_model* model = nullptr;
    EXPECT_EQ(haptoflow_model_open(&options, &model), HAPTOFLOW_MODEL_UNREADABLE);
    EXPECT_THAT(message(), ::testing::StartsWith("/nowhere/a.haptoflow"));
}

TEST(ModelApiTest, EitherBytesOrAPathMustBeGiven) {
    const auto bytes = tinyModelBytes();
    haptoflow_model* model = nullptr;
    const haptoflow_model_options both{sizeof(both), bytes.data(), bytes.size(), tinyModelPath.c_str()};
    EXPECT_EQ(haptoflow_model_open(&both, &model), HAPTOFLOW_INVALID_ARGUMENT);
    const haptoflow_model_options neither{sizeof(neither), nullptr, 0, nullptr};
    EXPECT_EQ(haptoflow_model_open(&neither, &model), HAPTOFLOW_INVALID_ARGUMENT);
}

class OpenModelTest : public WithTinyModel {};

TEST_F(OpenModelTest, TheLabelsAreListed) {
    uint32_t count = 0;
    ASSERT_EQ(haptoflow_model_label_count(model_, &count), HAPTOFLOW_OK);
    ASSERT_EQ(count, 2U);
    haptoflow_label_info info{};
    info.struct_size = sizeof(info);
    ASSERT_EQ(haptoflow_model_label(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "ruled");
    EXPECT_STREQ(info.category, "test");
    EXPECT_EQ(info.is_periodic, 1U);
    EXPECT_DOUBLE_EQ(info.wavelength_metres, 0.001);
    EXPECT_DOUBLE_EQ(info.stiffness_newtons_per_metre, 600.0);
    EXPECT_DOUBLE_EQ(info.friction_coefficient, 0.3);
    EXPECT_DOUBLE_EQ(info.speed_level_exponent, 0.5);
    EXPECT_DOUBLE_EQ(info.force_level_exponent, 0.25);
    EXPECT_DOUBLE_EQ(info.frequency_exponent, 1.0);
    EXPECT_EQ(haptoflow_model_label(model_, 2, &info), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("2 labels"));
}

TEST_F(OpenModelTest, TheEmbeddingOfALabelIsReturned) {
    std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding{};
    ASSERT_EQ(haptoflow_model_embedding(model_, 1, embedding.data()), HAPTOFLOW_OK);
    EXPECT_NEAR(embedding[10], std::sin(2.0), 1e-6);
    EXPECT_EQ(haptoflow_model_embedding(model_, 9, embedding.data()), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(OpenModelTest, TheHeadersTextsAndRangesAreReturned) {
    const char* text = nullptr;
    ASSERT_EQ(haptoflow_model_header(model_, &text), HAPTOFLOW_OK);
    const auto header = nlohmann::json::parse(text);
    haptoflow_model_info info{};
    info.struct_size = sizeof(info);
    ASSERT_EQ(haptoflow_model_describe(model_, &info), HAPTOFLOW_OK) << message();
    EXPECT_EQ(header["name"], info.name);
    EXPECT_EQ(header["description"], info.description);
    EXPECT_EQ(header["provenance"]["statement"], info.statement);
    EXPECT_EQ(header["provenance"]["recordings"], info.recordings);
    EXPECT_EQ(header["provenance"]["licence"], info.licence);
    EXPECT_EQ(header["provenance"]["commit"], info.commit);
    EXPECT_EQ(header["provenance"]["created"], info.created);
    EXPECT_EQ(header["range"]["speed_mps"], std::to_array(info.speed_mps));
    EXPECT_EQ(header["range"]["force_newtons"], std::to_array(info.force_newtons));
}

TEST_F(OpenModelTest, EveryLabelIsNearestToItselfWhateverItsWaveVectors) {
    for (uint32_t label = 0; label < 2; ++label) {
        std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding{};
        ASSERT_EQ(haptoflow_model_embedding(model_, label, embedding.data()), HAPTOFLOW_OK);
        std::fill(embedding.end() - 4, embedding.end(), 1000.0F);
        uint32_t nearest = 77;
        ASSERT_EQ(haptoflow_model_nearest_label(model_, embedding.data(), &nearest), HAPTOFLOW_OK) << message();
        EXPECT_EQ(nearest, label);
    }
}

TEST_F(OpenModelTest, TheTiersAreListed) {
    uint32_t count = 0;
    ASSERT_EQ(haptoflow_model_tier_count(model_, &count), HAPTOFLOW_OK);
    ASSERT_EQ(count, 5U);
    haptoflow_tier_info info{};
    info.struct_size = sizeof(info);
    ASSERT_EQ(haptoflow_model_tier(model_, 0, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "draft");
    EXPECT_STREQ(info.kind, "average-velocity");
    EXPECT_EQ(info.is_default, 0U);
    ASSERT_EQ(haptoflow_model_tier(model_, 2, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "fine");
    EXPECT_EQ(info.solver, HAPTOFLOW_SOLVER_HEUN);
    EXPECT_EQ(info.steps, 8);
    EXPECT_EQ(info.parameter_count, 267);
    EXPECT_STREQ(info.cost_json, "{}");
    ASSERT_EQ(haptoflow_model_tier(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_EQ(info.is_default, 1U);
}

}  // namespace
}  // namespace haptoflow::capi::testing
