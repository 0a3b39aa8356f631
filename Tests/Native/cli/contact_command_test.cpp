#include "commands.hpp"

#include "command_line.hpp"
#include "messages.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::cli {
namespace {

using ::testing::HasSubstr;

constexpr const char* header =
    "t,surface,touching,touch_counter,px,py,pz,nx,ny,nz,penetration_m,vx_mps,vy_mps,approach_mps,force_n,"
    "landing_counter,edge_counter,edge_height_m";

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) {
        lines.push_back(line);
    }
    return lines;
}

/// The number in the column `name` of a CSV line, whose columns are named by `headerLine`.
double numberOf(const std::string& headerLine, const std::string& line, const std::string& name) {
    std::istringstream columns(headerLine);
    std::istringstream cells(line);
    std::string column;
    std::string cell;
    while (std::getline(columns, column, ',') && std::getline(cells, cell, ',')) {
        if (column == name) {
            return std::stod(cell);
        }
    }
    throw std::out_of_range(name);
}

headless::Scene tableScene(const std::string& name) {
    headless::Scene scene;
    scene.surfaces.push_back({name, headless::Plane{}, {}, std::nullopt, {{"wood", 1.0}}, 1000.0, {1.0, 0.0, 0.0}});
    scene.updateRateHz = 100.0;
    return scene;
}

std::string statesOf(const headless::Scene& scene, const std::string& strokeText) {
    std::ostringstream output;
    writeContactStates(output, scene, headless::parseStroke(strokeText, "stroke.csv"), "stroke.csv", {});
    return output.str();
}

TEST(ContactCommandTest, AsRecordedEverySampleIsAFrameAtItsTime) {
    std::ostringstream output;
    writeContactStates(
        output, tableScene("table"),
        headless::parseStroke("t,x,y,z\n0,0,0,0\n0.011,0.0022,0,0\n0.019,0.0038,0,0\n0.031,0.0062,0,0\n", "s.csv"),
        "s.csv", {}, true);
    const auto lines = linesOf(output.str());
    ASSERT_EQ(lines.size(), 5U);
    for (const auto& [line, seconds] : {std::pair(2U, 0.011), {3U, 0.019}, {4U, 0.031}}) {
        EXPECT_DOUBLE_EQ(numberOf(header, lines[line], "t"), seconds);
        EXPECT_NEAR(numberOf(header, lines[line], "vx_mps"), 0.2, 1e-9);
    }
}

TEST(ContactCommandTest, EveryFrameIsALineInTheOrderOfTheHeader) {
    const auto lines = linesOf(statesOf(tableScene("table"), "t,x,y,z\n0,0,0.0005,0\n0.1,0.02,0.0005,0\n"));
    ASSERT_EQ(lines.size(), 12U);
    EXPECT_EQ(lines[0], header);
    EXPECT_EQ(lines[1], "0,table,1,1,0,0,0,0,1,0,0.0005,0,0,0,0.5,0,0,0");
    EXPECT_THAT(lines[11], HasSubstr("0.1,table,1,1,0.02,0,0,0,1,0,0.0005,0.2"));
}

TEST(ContactCommandTest, WithoutTouchTheSurfaceIsEmptyAndNamesWithCommasAreQuoted) {
    EXPECT_EQ(linesOf(statesOf(tableScene("table"), "t,x,y,z\n0,0,1,0\n"))[1], "0,,0,0,0,1,0,0,1,0,0,0,0,0,0,0,0,0");
    EXPECT_THAT(linesOf(statesOf(tableScene("a, \"b\""), "t,x,y,z\n0,0,0,0\n"))[1],
                HasSubstr("0,\"a, \"\"b\"\"\",1,1,"));
}

class ContactProgramTest : public testing::CommandLineTest {
protected:
    /// `contact` of the scene and a stroke that slides for 0.1 s, with more words.
    [[nodiscard]] testing::Finished contact(const std::string& words = "") const {
        return run("contact scene.json --stroke stroke.csv " + words);
    }

private:
    void SetUp() override {
        CommandLineTest::SetUp();
        write("stroke.csv", "t,x,y,z\n0,0,0.0005,0\n0.1,0.02,0.0005,0\n");
    }
};

TEST_F(ContactProgramTest, KeyframesLongAfterTheStrokeAreSaidToBeInAnotherUnit) {
    const auto scene = [](const std::string& time) {
        return R"({"surfaces": [{"name": "door", "shape": {"plane": {}}, "material": "wood", "motion": {"keyframes": )"
               R"([{"t": 0, "position": [0, 0, 0]}, {"t": )" +
               time + R"(, "position": [0.1, 0, 0]}]}}]})";
    };
    write("moving.json", scene("250"));
    const testing::Finished late = run("contact moving.json --stroke stroke.csv");
    EXPECT_EQ(late.exitCode, 0);
    EXPECT_THAT(late.errors,
                ::testing::HasSubstr("moving.json: the motion of \"door\" goes on to 250 s, the stroke to"));
    write("moving.json", scene("2.5"));
    EXPECT_EQ(run("contact moving.json --stroke stroke.csv").errors, "");
}

TEST_F(ContactProgramTest, ItPrintsTheStatesAndWritesTheSameTextToAFile) {
    const auto printed = contact();
    ASSERT_EQ(printed.exitCode, exitDone) << printed.errors;
    EXPECT_EQ(linesOf(printed.output).size(), 11U);
    const auto written = contact("-o states.csv");
    ASSERT_EQ(written.exitCode, exitDone) << written.errors;
    EXPECT_EQ(read("states.csv"), printed.output);
    EXPECT_EQ(written.output, "");
}

TEST_F(ContactProgramTest, ASurfaceWithoutStiffnessHasThatOfItsLabelsAsInRender) {
    struct Spring {
        double forceNewtons;
        double depthMetres;
    };
    const auto springOn = [this](const std::string& material) {
        write("scene.json",
              R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": )" + material + "}]}");
        const auto states = contact();
        EXPECT_EQ(states.exitCode, exitDone) << states.errors;
        const std::vector<std::string> lines = linesOf(states.output);
        return Spring{numberOf(lines.at(0), lines.at(1), "force_n"),
                      numberOf(lines.at(0), lines.at(1), "penetration_m")};
    };
    for (const auto& [material, stiffness] :
         {std::pair{"\"stone\"", 4000.0}, {"\"cotton\"", 250.0}, {R"({"wood": 1, "cotton": 3})", 487.5}}) {
        const Spring spring = springOn(material);
        EXPECT_GT(spring.depthMetres, 0.0) << material;
        EXPECT_NEAR(spring.forceNewtons, stiffness * spring.depthMetres, 1e-9) << material;
    }
}

TEST_F(ContactProgramTest, TheLabelsOfAGivenModelSetTheStiffness) {
    write("scene.json", R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": "rueld"}]})");
    const auto given = contact("--default-stiffness 2000");
    EXPECT_EQ(given.exitCode, exitDone);
    EXPECT_THAT(linesOf(given.output).at(1), HasSubstr("0.0005,0,0,0,1"));
    EXPECT_EQ(contact("--default-stiffness 2000 --model x.haptoflow").exitCode, exitUsage);
    EXPECT_EQ(contact("--model " + testing::tinyModel).exitCode, exitBadInput);
    write("scene.json", R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": "ruled"}]})");
    const auto known = contact("--model " + testing::tinyModel);
    EXPECT_EQ(known.exitCode, exitDone) << known.errors;
    EXPECT_THAT(linesOf(known.output).at(1), HasSubstr(",0.0005,0,0,0,0.3"));
}

TEST_F(ContactProgramTest, WrongOptionsAreUsageErrorsAndWrongFilesAreInputErrors) {
    write("short.csv", "t,x,y,z\n0,0,0\n");
    expectRefusals(
        {
            {"", exitUsage, "--stroke"},
            {"--stroke stroke.csv --default-stiffness -1", exitUsage, "--default-stiffness"},
            {"--stroke missing.csv", exitBadInput, "missing.csv: cannot be opened"},
            {"--stroke short.csv", exitBadInput, "short.csv:2: expected 4 values"},
            {"--stroke stroke.csv -o no/such/folder.csv", exitBadInput, "no/such/folder.csv"},
        },
        "contact scene.json ");
}

}  // namespace
}  // namespace haptoflow::cli
