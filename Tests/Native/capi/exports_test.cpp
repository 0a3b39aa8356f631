#include "public_header.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace haptoflow::capi::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// The symbols that `nm` prints for the plugin with these options.
std::set<std::string> definedSymbols(const std::string& options) {
    const std::string command = "nm " + options + " --defined-only --format=posix '" HAPTOFLOW_TEST_PLUGIN "'";
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::set<std::string> symbols;
    std::array<char, 4096> line{};
    while (pipe && std::fgets(line.data(), static_cast<int>(line.size()), pipe.get()) != nullptr) {
        std::istringstream words(line.data());
        std::string symbol;
        words >> symbol;
        symbols.insert(symbol);
    }
    return symbols;
}

TEST(ExportsTest, TheLibraryExportsTheHeadersFunctionsAndUnitysEntryOnly) {
    std::set<std::string> declared;
    for (const DeclaredFunction& function : declaredFunctions()) {
        declared.insert(function.name);
    }
    std::set<std::string> exported = definedSymbols("-D");
    EXPECT_EQ(exported.erase("UnityGetAudioEffectDefinitions"), 1U) << "Unity looks this function up by name";
    ASSERT_FALSE(declared.empty());
    EXPECT_EQ(exported, declared);
}

TEST(ExportsTest, TheLibraryContainsTheEngineAndNothingOfTheHeadlessContactModel) {
    std::ifstream map(HAPTOFLOW_TEST_PLUGIN ".map");
    const std::string text{std::istreambuf_iterator<char>(map), std::istreambuf_iterator<char>()};
    ASSERT_THAT(text, HasSubstr("libhaptoflow_engine.a(")) << "the linker's map is not there or has another form";
    EXPECT_THAT(text, HasSubstr("haptoflow6engine"));
    EXPECT_THAT(text, Not(HasSubstr("libhaptoflow_headless.a")));
    EXPECT_THAT(text, Not(HasSubstr("haptoflow8headless")));
}

TEST(ExportsTest, EveryFunctionOfTheHeaderHasACommentWithOneThreadTag) {
    const std::string text = textOf(HAPTOFLOW_TEST_HEADER);
    const std::regex beginning(R"(\nHAPTOFLOW_API )");
    const auto count = std::distance(std::sregex_iterator(text.begin(), text.end(), beginning), std::sregex_iterator());
    const auto functions = declaredFunctions();
    EXPECT_EQ(functions.size(), static_cast<std::size_t>(count)) << "a function has no comment before it";
    const std::regex tag(R"(\[((any|loader|worker)-thread|publisher|audio-callback)\])");
    for (const DeclaredFunction& function : functions) {
        const auto tags = std::distance(std::sregex_iterator(function.comment.begin(), function.comment.end(), tag),
                                        std::sregex_iterator());
        EXPECT_EQ(tags, 1) << function.name;
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
