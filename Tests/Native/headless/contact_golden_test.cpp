#include "contact_golden.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace haptoflow::headless {
namespace {

nlohmann::json goldenFile() {
    const std::string path = std::string(HAPTOFLOW_TEST_GOLDEN_DIR) + "/contact/contact-states.json";
    std::ifstream file(path, std::ios::binary);
    EXPECT_TRUE(file) << path << " is missing: see the README.md beside it";
    return nlohmann::json::parse(file);
}

TEST(ContactGoldenTest, EveryReadingOfTheGoldenFileIsReproduced) {
    const nlohmann::json document = goldenFile();
    ASSERT_EQ(document.at("format"), golden::fileFormat);
    ASSERT_EQ(document.at("version"), golden::fileVersion);
    ASSERT_GE(document.at("cases").size(), 8U);
    for (const nlohmann::json& entry : document.at("cases")) {
        const golden::Case testCase = golden::caseFromJson(entry);
        SCOPED_TRACE(testCase.name);
        const golden::Outcome outcome = golden::play(testCase);
        const nlohmann::json& expected = entry.at("expected");
        ASSERT_EQ(expected.at("columns"), golden::readingColumns());
        ASSERT_GE(expected.at("readings").size(), 50U);
        ASSERT_EQ(expected.at("readings").size(), outcome.readings.size());
        for (std::size_t frame = 0; frame < outcome.readings.size(); ++frame) {
            const std::vector<double> actual = golden::rowOf(outcome.readings[frame]);
            const auto wanted = expected.at("readings")[frame].get<std::vector<double>>();
            ASSERT_EQ(wanted.size(), actual.size());
            for (std::size_t column = 0; column < actual.size(); ++column) {
                EXPECT_NEAR(actual[column], wanted[column], 1e-9)
                    << "frame " << frame << ", " << golden::readingColumns()[column];
            }
        }
        EXPECT_EQ(golden::statisticsToJson(outcome.statistics), entry.at("statistics"));
        EXPECT_GT(outcome.statistics.touchDowns, 0U);
    }
}

TEST(ContactGoldenTest, AnObjectThatWasMovedAndTurnedKeepsThePlacesOnIt) {
    const nlohmann::json document = goldenFile();
    const auto entry = std::ranges::find(document.at("cases"), golden::carriedPlateName,
                                         [](const nlohmann::json& each) { return each.at("name"); });
    ASSERT_NE(entry, document.at("cases").end());
    const std::vector<ContactReading> readings = golden::play(golden::caseFromJson(*entry)).readings;
    const std::size_t half = readings.size() / 2;
    std::size_t compared = 0;
    for (std::size_t frame = 0; frame < half; ++frame) {
        const ContactReading& before = readings[frame];
        const ContactReading& after = readings[frame + half];
        ASSERT_EQ(before.touching, after.touching) << "frame " << frame;
        if (before.touching) {
            EXPECT_LT(glm::distance(before.placeMetres, after.placeMetres), 1e-9) << "frame " << frame;
            EXPECT_LT(glm::distance(before.firstAxis, after.firstAxis), 1e-9) << "frame " << frame;
            EXPECT_GT(glm::distance(before.pointMetres, after.pointMetres), 0.1) << "frame " << frame;
            ++compared;
        }
    }
    EXPECT_GT(compared, 30U);
}

}  // namespace
}  // namespace haptoflow::headless
