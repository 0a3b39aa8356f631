#include "headless/scenes/near_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using ::testing::ElementsAre;

const std::vector<std::string> labels{"wood", "plywood", "stone", "metal", "metal mesh", "fur", "rubber"};

TEST(NearWordsTest, AnAddedMissingWrongOrSwappedLetterIsADistanceOfOne) {
    EXPECT_EQ(lettersApart("wood", "wood"), 0U);
    EXPECT_EQ(lettersApart("wod", "wood"), 1U);
    EXPECT_EQ(lettersApart("woood", "wood"), 1U);
    EXPECT_EQ(lettersApart("wold", "wood"), 1U);
    EXPECT_EQ(lettersApart("owod", "wood"), 1U);
    EXPECT_EQ(lettersApart("", "wood"), 4U);
    EXPECT_EQ(lettersApart("fur", ""), 3U);
    EXPECT_EQ(lettersApart("stone", "metal"), lettersApart("metal", "stone"));
}

TEST(NearWordsTest, CapitalsUnderscoresAndHyphensAreIgnored) {
    EXPECT_EQ(lettersApart("Metal_Mesh", "metal mesh"), 0U);
    EXPECT_EQ(lettersApart("METAL-MESH", "metal mesh"), 0U);
}

TEST(NearWordsTest, TheNearestIsFirstAndAmongEquallyNearOnesTheOneThatContainsTheWord) {
    EXPECT_THAT(nearestWords("wod", labels, 3), ElementsAre("wood", "fur", "plywood"));
    EXPECT_THAT(nearestWords("Wood", labels, 1), ElementsAre("wood"));
    EXPECT_THAT(nearestWords("mesh", std::array<std::string, 2>{"carpeting", "mesh wire"}, 2),
                ElementsAre("mesh wire", "carpeting"));
    EXPECT_THAT(nearestWords("wood", labels, 99), ::testing::SizeIs(labels.size()));
    EXPECT_THAT(nearestWords("wood", {}, 3), ElementsAre());
}

TEST(NearWordsTest, AWordThatIsFarFromAllHasNoSuggestion) {
    EXPECT_EQ(likelyWord("stoen", labels), "stone");
    EXPECT_EQ(likelyWord("xylophone", labels), "");
    EXPECT_EQ(likelyWord("", labels), "");
    EXPECT_EQ(likelyWord("wood", {}), "");
}

TEST(NearWordsTest, TheQuestionListsTheWords) {
    EXPECT_EQ(didYouMean(std::array<std::string, 1>{"a"}), "did you mean 'a'?");
    EXPECT_EQ(didYouMean(std::array<std::string, 3>{"a", "b", "c"}), "did you mean 'a', 'b' or 'c'?");
}

}  // namespace
}  // namespace haptoflow::cli
