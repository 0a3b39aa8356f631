#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

std::set<std::string> exportedSymbols() {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(
        popen("nm -D --defined-only --format=posix '" HAPTOFLOW_TEST_PLUGIN "'", "r"), pclose);
    std::set<std::string> symbols;
    char line[4096];
    while (pipe && std::fgets(line, sizeof(line), pipe.get()) != nullptr) {
        std::istringstream words(line);
        std::string symbol;
        words >> symbol;
        symbols.insert(symbol);
    }
    return symbols;
}

std::string headerText() {
    std::ifstream stream(HAPTOFLOW_TEST_HEADER);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Name of each function of the header, with the comment before it.
std::vector<std::pair<std::string, std::string>> declaredFunctions() {
    const std::string text = headerText();
    const std::regex declaration(R"(/\*((?:[^*]|\*(?!/))*)\*/\s*HAPTOFLOW_API[^(;]*?(haptoflow_\w+)\()");
    std::vector<std::pair<std::string, std::string>> functions;
    for (std::sregex_iterator match(text.begin(), text.end(), declaration), end; match != end; ++match) {
        functions.emplace_back((*match)[2], (*match)[1]);
    }
    return functions;
}

TEST(ExportsTest, TheLibraryExportsTheHeadersFunctionsAndUnitysEntryOnly) {
    std::set<std::string> declared;
    for (const auto& [name, comment] : declaredFunctions()) {
        declared.insert(name);
    }
    std::set<std::string> exported = exportedSymbols();
    EXPECT_EQ(exported.erase("UnityGetAudioEffectDefinitions"), 1U) << "what Unity looks up by name";
    ASSERT_FALSE(declared.empty());
    EXPECT_EQ(exported, declared);
}

TEST(ExportsTest, EveryFunctionOfTheHeaderHasACommentWithOneThreadTag) {
    const std::string text = headerText();
    const std::regex function(R"(\nHAPTOFLOW_API )");
    const auto count = std::distance(std::sregex_iterator(text.begin(), text.end(), function), std::sregex_iterator());
    const auto functions = declaredFunctions();
    EXPECT_EQ(functions.size(), static_cast<std::size_t>(count)) << "a function stands without a comment before it";
    const std::regex tag(R"(\[((any|loader|worker)-thread|publisher|audio-callback)\])");
    for (const auto& [name, comment] : functions) {
        const auto tags =
            std::distance(std::sregex_iterator(comment.begin(), comment.end(), tag), std::sregex_iterator());
        EXPECT_EQ(tags, 1) << name;
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
