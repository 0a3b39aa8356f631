#include <gtest/gtest.h>

#include <cstdlib>

namespace haptoflow::unity::testing {
namespace {

void allocatesLikeNoCallbackMay() noexcept [[clang::nonblocking]] {
    void* volatile memory = std::malloc(16);
    std::free(memory);
}

TEST(RealtimeSanitizerDeathTest, AnAllocatingCallbackEndsTheProgram) {
    EXPECT_DEATH(allocatesLikeNoCallbackMay(), "malloc");
}

}  // namespace
}  // namespace haptoflow::unity::testing
