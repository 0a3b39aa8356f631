#include "model/plain_text.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>
#include <vector>

namespace haptoflow::model {
namespace {

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
}  // namespace haptoflow::model
