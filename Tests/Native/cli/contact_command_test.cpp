#include "contact_command.hpp"

#include "exit_codes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#ifndef _WIN32
#include <sys/wait.h>
#endif

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
    writeContactStates(output, scene, parseStroke(strokeText, "stroke.csv"), "stroke.csv", {});
    return output.str();
}

TEST(ContactCommandTest, OneLinePerFrameInTheOrderOfTheHeader) {
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

class ContactProgramTest : public ::testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::temp_directory_path() /
                  ("haptoflow_contact_program_" +
                   std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::create_directories(folder_);
        write("scene.json", R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": "wood"}]})");
        write("stroke.csv", "t,x,y,z\n0,0,0.0005,0\n0.1,0.02,0.0005,0\n");
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::string read(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        std::ostringstream text;
        text << file.rdbuf();
        return text.str();
    }
    [[nodiscard]] std::string at(const std::string& name) const {
        return std::string(1, '"').append((folder_ / name).string()).append(1, '"');
    }

    /// Runs the program; its exit code.
    [[nodiscard]] int run(const std::string& words) const {
        const std::string command =
            "\"" HAPTOFLOW_TEST_CLI "\" " + words + " >" + at("out.txt") + " 2>" + at("err.txt");
        const int status = std::system(command.c_str());  // NOLINT(concurrency-mt-unsafe,cert-env33-c)
#ifdef _WIN32
        return status;
#else
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
#endif
    }

private:
    std::filesystem::path folder_;
};

TEST_F(ContactProgramTest, PrintsStatesAndWritesTheSameToAFile) {
    ASSERT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv")), exitDone) << read("err.txt");
    const std::string printed = read("out.txt");
    EXPECT_EQ(linesOf(printed).size(), 11U);
    ASSERT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " -o " + at("states.csv")),
              exitDone);
    EXPECT_EQ(read("states.csv"), printed);
    EXPECT_EQ(read("out.txt"), "");
}

TEST_F(ContactProgramTest, DefaultStiffnessAndMaximumForceActOnTheForce) {
    ASSERT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " --default-stiffness 2000"),
              exitDone);
    EXPECT_THAT(linesOf(read("out.txt"))[1], HasSubstr("0.0005,0,0,0,1"));
    ASSERT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " --maximum-force 0.125"),
              exitDone);
    EXPECT_THAT(linesOf(read("out.txt"))[1], HasSubstr("0.0005,0,0,0,0.125"));
}

TEST_F(ContactProgramTest, ASurfaceWithoutStiffnessPressesBackWithItsLabelsAsInRender) {
    struct Spring {
        double forceNewtons;
        double depthMetres;
    };
    const auto springOn = [this](const std::string& material) {
        write("scene.json",
              R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": )" + material + "}]}");
        EXPECT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv")), exitDone) << read("err.txt");
        const std::vector<std::string> lines = linesOf(read("out.txt"));
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

TEST_F(ContactProgramTest, WithAModelOfTheUsersOwnItsLabelsGiveTheStiffness) {
    write("scene.json", R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": "rueld"}]})");
    const std::string words = "contact " + at("scene.json") + " --stroke " + at("stroke.csv");
    EXPECT_EQ(run(words), exitBadInput);
    EXPECT_THAT(read("err.txt"), HasSubstr("'rueld', which the model does not know"));
    EXPECT_EQ(run(words + " --default-stiffness 2000"), exitDone) << read("err.txt");
    EXPECT_EQ(run(words + " --default-stiffness 2000 --model x.haptoflow"), exitUsage);
    EXPECT_EQ(run(words + " --model " HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow"), exitBadInput);
    write("scene.json", R"({"surfaces": [{"name": "table", "shape": {"plane": {}}, "material": "ruled"}]})");
    EXPECT_EQ(run(words + " --model " HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow"), exitDone) << read("err.txt");
    EXPECT_THAT(linesOf(read("out.txt")).at(1), HasSubstr(",0.0005,0,0,0,0.3"));
}

TEST_F(ContactProgramTest, AnOutputThatIsAnInputIsRefusedAndALinkIsFollowed) {
    const std::string words = "contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " -o ";
    const std::string scene = read("scene.json");
    EXPECT_EQ(run(words + at("scene.json")), exitUsage);
    EXPECT_THAT(read("err.txt"), HasSubstr("is the same file as the scene"));
    EXPECT_EQ(run(words + at("stroke.csv")), exitUsage);
    EXPECT_EQ(read("scene.json"), scene);
    std::filesystem::create_symlink("states.csv", at("link.csv").substr(1, at("link.csv").size() - 2));
    EXPECT_EQ(run(words + at("link.csv")), exitDone) << read("err.txt");
    EXPECT_EQ(linesOf(read("states.csv")).size(), 11U);
}

TEST_F(ContactProgramTest, WrongWordsAreUsageAndWrongFilesAreInput) {
    EXPECT_EQ(run("contact " + at("scene.json")), exitUsage);
    EXPECT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " --default-stiffness -1"),
              exitUsage);
    EXPECT_EQ(run("contact " + at("scene.json") + " --stroke " + at("missing.csv")), exitBadInput);
    EXPECT_THAT(read("err.txt"), HasSubstr("missing.csv: cannot be opened"));
    write("stroke.csv", "t,x,y,z\n0,0,0\n");
    EXPECT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv")), exitBadInput);
    EXPECT_THAT(read("err.txt"), HasSubstr("stroke.csv:2: expected 4 values"));
    write("stroke.csv", "t,x,y,z\n0,0,0,0\n");
    EXPECT_EQ(run("contact " + at("scene.json") + " --stroke " + at("stroke.csv") + " -o " + at("no/such/folder.csv")),
              exitBadInput);
}

TEST_F(ContactProgramTest, HelpSaysWhatTheFilesAreAndGivesAnExample) {
    ASSERT_EQ(run("contact --help"), exitDone);
    EXPECT_THAT(read("out.txt"), HasSubstr("haptoflow contact scene.json --stroke stroke.csv"));
    EXPECT_THAT(read("out.txt"), HasSubstr("t,x,y,z[,force][,qx,qy,qz,qw]"));
}

}  // namespace
}  // namespace haptoflow::cli
