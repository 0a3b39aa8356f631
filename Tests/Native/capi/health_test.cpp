#include "open_engine.hpp"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

/// One engine, used through the C interface alone.
class HealthTest : public ::testing::Test {
protected:
    OpenEngine open_{tinyModelPath};

    [[nodiscard]] haptoflow_silence silence() const { return open_.statistics().silence; }
};

TEST_F(HealthTest, TheReasonForSilenceIsTold) {
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_REST);
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_NONE);
    ASSERT_EQ(haptoflow_voice_set_muted(open_.voice, 1), HAPTOFLOW_OK);
    (void)open_.render(256);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_MUTED);
    ASSERT_EQ(haptoflow_voice_set_muted(open_.voice, 0), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_voice_set_paused(open_.voice, 1), HAPTOFLOW_OK);
    (void)open_.render(256);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_PAUSED);
    ASSERT_EQ(haptoflow_voice_set_paused(open_.voice, 0), HAPTOFLOW_OK);
    (void)open_.render(5000);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_STALE);
    (void)open_.update(slidingState());
    ASSERT_EQ(haptoflow_voice_panic(open_.voice), HAPTOFLOW_OK);
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_PANIC);
    haptoflow_contact_state next = slidingState();
    next.touch_counter = 2;
    (void)open_.update(next);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_NONE);
}

TEST_F(HealthTest, TheFailureTextIsEmptyAtFirstAndFitsAnyBuffer) {
    uint64_t length = 99;
    std::array<char, 4> text{'x', 'x', 'x', 'x'};
    ASSERT_EQ(haptoflow_engine_last_failure(open_.engine, text.data(), text.size(), &length), HAPTOFLOW_OK);
    EXPECT_EQ(length, 0U);
    EXPECT_EQ(text[0], '\0');
    EXPECT_EQ(haptoflow_engine_last_failure(open_.engine, nullptr, 0, &length), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_engine_last_failure(open_.engine, nullptr, 4, &length), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_engine_last_failure(nullptr, text.data(), text.size(), &length), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(HealthTest, ARunningEngineReportsThatItsWorkerIsAlive) {
    EXPECT_EQ(open_.engineStatistics().worker_is_alive, 1U);
    EXPECT_EQ(open_.engineStatistics().priority_was_refused, 0U) << "without worker no priority is requested";
}

}  // namespace
}  // namespace haptoflow::capi::testing
