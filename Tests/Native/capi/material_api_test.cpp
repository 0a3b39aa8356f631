#include "model/material_builder.hpp"
#include "open_engine.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::string spaceOf(const haptoflow_model* model) {
    const char* space = nullptr;
    EXPECT_EQ(haptoflow_model_space(model, &space), HAPTOFLOW_OK) << message();
    return space == nullptr ? "" : space;
}

class MaterialApiTest : public ::testing::Test {
protected:
    /// The text of a valid material of the model, with changes of the test.
    [[nodiscard]] std::string material(const std::function<void(json&)>& change = {}) const {
        json text = model::testing::validMaterial(spaceOf(open_.model));
        if (change) {
            change(text);
        }
        return text.dump();
    }
    haptoflow_status add(const std::string& text, uint32_t* index) {
        return haptoflow_engine_register_material(open_.engine, text.data(), text.size(), index);
    }
    [[nodiscard]] uint32_t count() const {
        uint32_t found = 0;
        EXPECT_EQ(haptoflow_engine_material_count(open_.engine, &found), HAPTOFLOW_OK) << message();
        return found;
    }
    [[nodiscard]] uint32_t labels() const {
        uint32_t found = 0;
        EXPECT_EQ(haptoflow_model_label_count(open_.model, &found), HAPTOFLOW_OK);
        return found;
    }
    static haptoflow_contact_state on(uint32_t label) {
        haptoflow_contact_state state = slidingState();
        state.labels[0] = label;
        return state;
    }

    OpenEngine open_{tinyModelPath};
};

TEST_F(MaterialApiTest, TheModelsSpaceIsThatOfTheGoldenFile) {
    std::ifstream stream(HAPTOFLOW_TEST_GOLDEN_DIR "/material/expected.json");
    EXPECT_EQ(spaceOf(open_.model), json::parse(stream).at("spaces").at("tiny").get<std::string>());
}

TEST_F(MaterialApiTest, AReadMaterialIsDescribedUntilItIsClosed) {
    const std::string text = material([](auto& made) { made["level_offset_db"] = -3.5; });
    haptoflow_material* read = nullptr;
    ASSERT_EQ(haptoflow_material_read(text.data(), text.size(), &read), HAPTOFLOW_OK) << message();
    auto info = sized<haptoflow_material_info>();
    ASSERT_EQ(haptoflow_material_describe(read, &info), HAPTOFLOW_OK) << message();
    EXPECT_STREQ(info.name, "denim");
    EXPECT_STREQ(info.category, "cloth");
    EXPECT_STREQ(info.description, "A pair of jeans.");
    EXPECT_EQ(info.space, spaceOf(open_.model));
    EXPECT_STREQ(info.statement, "learnt");
    EXPECT_STREQ(info.recordings, "one");
    EXPECT_STREQ(info.licence, "unknown");
    EXPECT_STREQ(info.created, "2026-11-23");
    EXPECT_EQ(info.seconds, 10.5);
    EXPECT_EQ(info.stiffness_newtons_per_metre, 300.0);
    EXPECT_EQ(info.level_offset_db, -3.5);
    EXPECT_THAT(info.speed_mps, ::testing::ElementsAre(0.02, 0.18));
    EXPECT_THAT(info.force_newtons, ::testing::ElementsAre(1.0, 1.0));
    std::vector<float> embedding(HAPTOFLOW_EMBEDDING_SIZE);
    ASSERT_EQ(haptoflow_material_embedding(read, embedding.data()), HAPTOFLOW_OK) << message();
    EXPECT_THAT(embedding, ::testing::Each(0.5F));
    ASSERT_EQ(haptoflow_material_close(&read), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_material_describe(read, &info), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(MaterialApiTest, AnInvalidMaterialIsNotReadAndItsKeyNamed) {
    haptoflow_material* read = nullptr;
    const std::string text = material([](auto& made) { made.erase("space"); });
    EXPECT_EQ(haptoflow_material_read(text.data(), text.size(), &read), HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_THAT(message(), HasSubstr("\"space\""));
    EXPECT_EQ(haptoflow_material_read(text.data(), UINT64_MAX, &read), HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_EQ(haptoflow_material_read(text.data(), 0, &read), HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_EQ(read, nullptr);
}

TEST_F(MaterialApiTest, ARegisteredMaterialIsCountedDescribedAndRendered) {
    uint32_t index = 0;
    ASSERT_EQ(add(material(), &index), HAPTOFLOW_OK) << message();
    EXPECT_EQ(index, labels());
    EXPECT_EQ(count(), 1U);
    auto info = sized<haptoflow_label_info>();
    ASSERT_EQ(haptoflow_engine_material(open_.engine, index, &info), HAPTOFLOW_OK) << message();
    EXPECT_STREQ(info.name, "denim");
    EXPECT_STREQ(info.category, "cloth");
    EXPECT_EQ(info.stiffness_newtons_per_metre, 300.0);
    EXPECT_EQ(info.wavelength_metres, 0.002);
    EXPECT_GT(peak(open_.update(on(index))), 0.0F);
    EXPECT_GT(open_.effect(HAPTOFLOW_EFFECT_TONE).runs, 0U);
    EXPECT_EQ(open_.effect(HAPTOFLOW_EFFECT_TONE).is_asked_for, 1U);
    EXPECT_EQ(open_.statistics().sanitised, 0U);
}

TEST_F(MaterialApiTest, AnInvalidMaterialIsRefusedWithItsKeyAndTheIndexStaysUnchanged) {
    uint32_t index = 77;
    EXPECT_EQ(add(material([](json& text) { text["embedding"].erase(0); }), &index), HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_THAT(message(), HasSubstr("material key \"embedding\""));
    EXPECT_EQ(add("{", &index), HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_THAT(message(), HasSubstr("not valid JSON"));
    EXPECT_EQ(add(material([](json& text) { text["space"] = "00000000"; }), &index), HAPTOFLOW_MATERIAL_MISMATCH);
    EXPECT_THAT(message(), HasSubstr("learn the material again"));
    const std::string valid = material();
    EXPECT_EQ(haptoflow_engine_register_material(open_.engine, valid.data(), UINT64_MAX, &index),
              HAPTOFLOW_MATERIAL_INVALID);
    EXPECT_EQ(index, 77U);
    EXPECT_EQ(count(), 0U);
}

TEST_F(MaterialApiTest, AReplacementSoundsWithTheNextStateAndARefusedOneLeavesTheMaterialUnchanged) {
    uint32_t index = 0;
    ASSERT_EQ(add(material([](json& text) { text["level_offset_db"] = -24.0; }), &index), HAPTOFLOW_OK) << message();
    (void)open_.update(on(index));
    const float soft = peak(open_.update(on(index)));
    const std::string broken = material([](json& text) { text["version"] = 9; });
    EXPECT_EQ(haptoflow_engine_replace_material(open_.engine, index, broken.data(), broken.size()),
              HAPTOFLOW_MATERIAL_INVALID);
    auto info = sized<haptoflow_label_info>();
    ASSERT_EQ(haptoflow_engine_material(open_.engine, index, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "denim");
    const std::string loud = material([](json& text) { text["level_offset_db"] = 12.0; });
    ASSERT_EQ(haptoflow_engine_replace_material(open_.engine, index, loud.data(), loud.size()), HAPTOFLOW_OK)
        << message();
    (void)open_.play(10, on(index));
    EXPECT_GT(peak(open_.update(on(index))), 4.0F * soft);
    EXPECT_EQ(count(), 1U);
    for (const uint32_t none : {0U, index + 1, UINT32_MAX}) {
        EXPECT_EQ(haptoflow_engine_replace_material(open_.engine, none, loud.data(), loud.size()),
                  HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_EQ(haptoflow_engine_material(open_.engine, none, &info), HAPTOFLOW_INVALID_ARGUMENT);
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
