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

    [[nodiscard]] std::string silence() const {
        return haptoflow_silence_name(open_.statistics().silence) + std::string("HAPTOFLOW_SILENCE_").length();
    }
};

TEST_F(HealthTest, TheReasonForSilenceIsReadableByName) {
    EXPECT_EQ(silence(), "REST");
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), "NONE");
    ASSERT_EQ(haptoflow_voice_set_muted(open_.voice, 1), HAPTOFLOW_OK);
    (void)open_.render(256);
    EXPECT_EQ(silence(), "MUTED");
    ASSERT_EQ(haptoflow_voice_set_muted(open_.voice, 0), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_voice_set_paused(open_.voice, 1), HAPTOFLOW_OK);
    (void)open_.render(256);
    EXPECT_EQ(silence(), "PAUSED");
    ASSERT_EQ(haptoflow_voice_set_paused(open_.voice, 0), HAPTOFLOW_OK);
    (void)open_.render(5000);
    EXPECT_EQ(silence(), "STALE");
    (void)open_.update(slidingState());
    ASSERT_EQ(haptoflow_voice_panic(open_.voice), HAPTOFLOW_OK);
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), "PANIC");
    haptoflow_contact_state next = slidingState();
    next.touch_counter = 2;
    (void)open_.update(next);
    EXPECT_EQ(silence(), "NONE");
}

TEST_F(HealthTest, AVoiceThatIsTurnedDownSaysSo) {
    (void)open_.update(slidingState());
    ASSERT_EQ(haptoflow_voice_set_strength(open_.voice, 0.0F), HAPTOFLOW_OK);
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), "TURNED_DOWN");
    ASSERT_EQ(haptoflow_voice_set_strength(open_.voice, 1.0F), HAPTOFLOW_OK);
    (void)open_.update(slidingState());
    EXPECT_EQ(silence(), "NONE");
    ASSERT_EQ(haptoflow_voice_set_ceiling(open_.voice, 0.0F), HAPTOFLOW_OK);
    EXPECT_EQ(peak(open_.update(slidingState())), 0.0F);
    EXPECT_EQ(silence(), "TURNED_DOWN");
}

TEST_F(HealthTest, EveryReasonHasANameAndOtherNumbersHaveNone) {
    for (haptoflow_silence reason = HAPTOFLOW_SILENCE_NONE; reason <= HAPTOFLOW_SILENCE_TURNED_DOWN; ++reason) {
        EXPECT_STRNE(haptoflow_silence_name(reason), "HAPTOFLOW_UNKNOWN_SILENCE") << reason;
    }
    for (const haptoflow_silence none : {-1, HAPTOFLOW_SILENCE_TURNED_DOWN + 1, std::numeric_limits<int32_t>::max()}) {
        EXPECT_STREQ(haptoflow_silence_name(none), "HAPTOFLOW_UNKNOWN_SILENCE") << none;
    }
}

TEST_F(HealthTest, AnUnsupportedDeviceRateIsCountedAndReportedAndTheTouchResumesAfterIt) {
    (void)open_.update(slidingState());
    std::vector<float> output = open_.render(960, 4000.0);
    EXPECT_EQ(peak({output.end() - 480, output.end()}), 0.0F);
    haptoflow_voice_statistics statistics = open_.statistics();
    EXPECT_EQ(statistics.unsupported_rate_blocks, 1U);
    EXPECT_EQ(statistics.device_rate_hz, 4000.0);
    EXPECT_EQ(statistics.is_rate_supported, 0U);
    EXPECT_EQ(statistics.silence, HAPTOFLOW_SILENCE_RATE);
    EXPECT_EQ(statistics.rate_changes, 0U);
    // Another label, speed and force in the block that restores the rate.
    haptoflow_contact_state other = slidingState(-0.3F, 0.4F);
    other.labels[0] = 1;
    EXPECT_GT(peak(open_.update(other)), 0.0F);
    statistics = open_.statistics();
    EXPECT_EQ(statistics.silence, HAPTOFLOW_SILENCE_NONE);
    EXPECT_EQ(statistics.is_rate_supported, 1U);
    EXPECT_EQ(statistics.resumptions, 1U);
    EXPECT_EQ(statistics.onsets, 1U);
}

TEST_F(HealthTest, AStrengthSetBeforeATouchAppliesFromItsFirstSample) {
    (void)open_.update(slidingState());
    (void)open_.update(liftedState());
    ASSERT_EQ(haptoflow_voice_set_strength(open_.voice, 0.0F), HAPTOFLOW_OK);
    haptoflow_contact_state next = slidingState(0.2F, 2.0F);
    next.touch_counter = 2;
    EXPECT_EQ(peak(open_.update(next, 4800)), 0.0F);
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
