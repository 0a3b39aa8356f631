#include "progress_bar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

TEST(ProgressTest, WithoutATerminalALineIsPrintedEveryTenSeconds) {
    double nowSeconds = 100.0;
    std::vector<std::string> lines;
    const ProgressBar bar = progressLines(
        "render", [&nowSeconds] { return nowSeconds; }, [&lines](const std::string& line) { lines.push_back(line); });
    for (int second = 0; second <= 45; ++second) {
        nowSeconds = 100.0 + second;
        bar(second / 50.0, {});
    }
    EXPECT_THAT(lines, ::testing::ElementsAre("render: 20 %", "render: 40 %", "render: 60 %", "render: 80 %"));
}

TEST(ProgressTest, AShortRunPrintsNothing) {
    double nowSeconds = 0.0;
    const ProgressBar bar = progressLines(
        "render", [&nowSeconds] { return nowSeconds; }, [](const std::string& line) { ADD_FAILURE() << line; });
    for (; nowSeconds < 9.9; nowSeconds += 0.1) {
        bar(nowSeconds / 10.0, "callback");
    }
}

}  // namespace
}  // namespace haptoflow::cli
