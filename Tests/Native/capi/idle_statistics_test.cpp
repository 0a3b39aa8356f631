// Statistics of an engine and its voice after two seconds in which nothing slides.
#include "open_engine.hpp"

#include <bit>
#include <tuple>

namespace haptoflow::capi::testing {
namespace {

constexpr uint32_t updatesInTwoSeconds = 144;
constexpr uint32_t framesOfAnUpdate = 667;

using VoiceFigures = std::array<std::uint64_t, sizeof(haptoflow_voice_statistics) / sizeof(std::uint64_t)>;

/// The parameter: without a worker, and with one.
class IdleStatisticsTest : public ::testing::TestWithParam<bool> {
protected:
    void play(const haptoflow_contact_state& state) {
        for (uint32_t update = 0; update < updatesInTwoSeconds; ++update) {
            open_.publish(state);
            EXPECT_EQ(peak(open_.render(framesOfAnUpdate)), 0.0F);
            if (!GetParam()) {
                EXPECT_EQ(haptoflow_engine_step(open_.engine), HAPTOFLOW_OK) << message();
            }
        }
    }

    /// Expects zero in every field that `expected` does not set, including fields added in later versions.
    void expectVoice(haptoflow_voice_statistics expected) const {
        expected.struct_size = sizeof(expected);
        expected.updates = updatesInTwoSeconds;
        expected.rendered_frames = updatesInTwoSeconds * framesOfAnUpdate;
        expected.device_rate_hz = 48000.0;
        expected.is_rate_supported = 1;
        expected.silence = HAPTOFLOW_SILENCE_REST;
        EXPECT_EQ(std::bit_cast<VoiceFigures>(open_.statistics()), std::bit_cast<VoiceFigures>(expected));
    }

    void expectIdleEngine() const {
        const haptoflow_engine_statistics found = open_.engineStatistics();
        EXPECT_EQ(found.tier, 0U);
        EXPECT_EQ(found.voices, 1U);
        EXPECT_EQ(found.is_measuring, 0U);
        EXPECT_EQ(found.rounds, 0U);
        EXPECT_EQ(found.segments, 0U);
        EXPECT_EQ(found.failed_rounds, 0U);
        EXPECT_EQ(found.wakes, wakesAtFirst_);
        EXPECT_EQ(found.quality_steps_down, 0U);
        EXPECT_EQ(found.quality_steps_up, 0U);
        EXPECT_EQ(found.last_round_ms, 0.0);
        EXPECT_EQ(found.worker_is_alive, 1U);
        EXPECT_NEAR(found.budget_ms, 250.0 / 72.0, 1e-9);
        uint32_t tiers = 0;
        ASSERT_EQ(haptoflow_model_tier_count(open_.model, &tiers), HAPTOFLOW_OK);
        for (uint32_t tier = 0; tier < tiers; ++tier) {
            haptoflow_tier_times times{};
            times.struct_size = sizeof(times);
            ASSERT_EQ(haptoflow_engine_tier_times(open_.engine, tier, &times), HAPTOFLOW_OK);
            EXPECT_EQ(std::tie(times.runs, times.median_ms, times.percentile_99_ms), std::tuple(0U, 0.0, 0.0)) << tier;
        }
    }

    OpenEngine open_{tinyModelPath, GetParam()};
    std::uint64_t wakesAtFirst_ = open_.engineStatistics().wakes;
};

TEST_P(IdleStatisticsTest, WithoutTouchAllStatisticsButUpdatesAndFramesAreZero) {
    play(liftedState(0));
    expectVoice({});
    expectIdleEngine();
}

TEST_P(IdleStatisticsTest, ARestingTouchIsSkippedAndAllOtherStatisticsAreZero) {
    play(slidingState(0.0F, 2.0F));
    haptoflow_voice_statistics expected{};
    expected.skipped = updatesInTwoSeconds;
    expectVoice(expected);
    expectIdleEngine();
}

INSTANTIATE_TEST_SUITE_P(Engine, IdleStatisticsTest, ::testing::Bool(),
                         [](const auto& hasWorker) { return hasWorker.param ? "WithWorker" : "SteppedByHand"; });

}  // namespace
}  // namespace haptoflow::capi::testing
