#include <features.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <regex>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

/// The oldest glibc of the systems that Unity 2022.3 supports: that of Ubuntu 20.04.
constexpr int oldestMinor = 31;

/// The newest glibc for which older_glibc.c has every function: that of Debian 12, which builds the libraries of a
/// release.
constexpr int newestMinor = 36;

std::string linesOf(const std::string& command) {
    const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::string lines;
    char line[4096];
    while (pipe && std::fgets(line, sizeof(line), pipe.get()) != nullptr) {
        lines += line;
    }
    return lines;
}

TEST(GlibcTest, TheLibraryNeedsNoFunctionThatIsNewerThanGlibc231) {
    if (__GLIBC_MINOR__ > newestMinor) {
        GTEST_SKIP() << "this system's glibc is newer than Debian 12's, on which the libraries of a release are built";
    }
    const std::string symbols = linesOf("nm -D --undefined-only '" HAPTOFLOW_TEST_PLUGIN "'");
    const std::regex versioned(R"((\w+)@GLIBC_2\.(\d+))");
    int found = 0;
    for (std::sregex_iterator match(symbols.begin(), symbols.end(), versioned), end; match != end; ++match) {
        ++found;
        EXPECT_LE(std::stoi((*match)[2]), oldestMinor)
            << (*match)[1] << " got a new version after glibc 2.31: add the version before it to older_glibc.c";
    }
    EXPECT_GT(found, 50) << symbols;
}

TEST(GlibcTest, TheLibraryNeedsNoCxxLibraryAndNamesThoseThatGlibc231HasBesideLibc) {
    const std::string symbols = linesOf("nm -D --undefined-only '" HAPTOFLOW_TEST_PLUGIN "'");
    EXPECT_EQ(symbols.find("GLIBCXX"), std::string::npos) << "an older system's libstdc++ lacks newer functions";
    const std::string headers = linesOf("objdump -p '" HAPTOFLOW_TEST_PLUGIN "'");
    std::vector<std::string> needed;
    const std::regex entry(R"(NEEDED +(\S+))");
    for (std::sregex_iterator match(headers.begin(), headers.end(), entry), end; match != end; ++match) {
        needed.push_back((*match)[1]);
    }
    const auto needs = [&](const std::string& name) { return std::ranges::find(needed, name) != needed.end(); };
    EXPECT_FALSE(needs("libstdc++.so.6"));
    EXPECT_TRUE(needs("libpthread.so.0"));
    EXPECT_TRUE(needs("libdl.so.2"));
}

}  // namespace
}  // namespace haptoflow::capi::testing
