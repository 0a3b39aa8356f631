#include "headless/command_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace haptoflow::headless {
namespace {

using ::testing::ElementsAre;

const std::vector<std::string> labels{"wood", "plywood", "stone", "metal", "metal mesh", "fur", "rubber"};

TEST(NearWordsTest, ADistanceCountsLettersAddedRemovedChangedOrSwapped) {
    struct Row {
        const char* one;
        const char* other;
        std::size_t apart;
    };
    for (const Row& row : {Row{"wood", "wood", 0},
                           {"wod", "wood", 1},
                           {"woood", "wood", 1},
                           {"wold", "wood", 1},
                           {"owod", "wood", 1},
                           {"", "wood", 4},
                           {"fur", "", 3},
                           {"METAL-Mesh", "metal_mesh", 0}}) {
        EXPECT_EQ(lettersApart(row.one, row.other), row.apart) << row.one << ", " << row.other;
    }
}

TEST(NearWordsTest, TheNearestIsFirstAndAmongEquallyNearOnesTheOneThatContainsTheWord) {
    EXPECT_THAT(nearestWords("wod", labels, 3), ElementsAre("wood", "fur", "plywood"));
    EXPECT_THAT(nearestWords("mesh", std::array<std::string, 2>{"carpeting", "mesh wire"}, 2),
                ElementsAre("mesh wire", "carpeting"));
    EXPECT_THAT(nearestWords("wood", {}, 3), ElementsAre());
    EXPECT_EQ(likelyWord("stoen", labels), "stone");
    EXPECT_EQ(likelyWord("xylophone", labels), "");
    EXPECT_EQ(didYouMean(std::array<std::string, 3>{"a", "b", "c"}), "did you mean 'a', 'b' or 'c'?");
}

}  // namespace
}  // namespace haptoflow::headless
