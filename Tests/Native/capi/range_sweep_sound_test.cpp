// A hand whose speed or force increases slowly and far beyond the recorded range, up to the rendered sound: each tier
// of the shipped model must follow the level model and the law that RangeSweepTest checks.
#include "output_checks.hpp"

#include <cmath>
#include <functional>
#include <string>
#include <tuple>

namespace haptoflow::capi::testing {
namespace {

constexpr double sweepOutputHz = 8000.0;
constexpr double sweepUpdateHz = 72.0;
constexpr double sweepSeconds = 24.0;
constexpr double windowSeconds = 0.5;

/// Level in decibels of each window of a sweep; `state` gives the contact state at a share of the sweep, 0 to 1.
std::vector<double> sweptLevels(haptoflow_quality quality, uint32_t label,
                                const std::function<haptoflow_contact_state(float)>& state) {
    OpenEngine open(defaultModelPath, false, quality, 1, sweepOutputHz);
    std::vector<float> output;
    const auto updates = static_cast<uint32_t>(sweepSeconds * sweepUpdateHz);
    for (uint32_t update = 0; update < updates; ++update) {
        haptoflow_contact_state published = state(static_cast<float>(update) / static_cast<float>(updates));
        published.labels[0] = label;
        open.publish(published);
        const auto part = open.render(static_cast<uint32_t>(sweepOutputHz / sweepUpdateHz), sweepOutputHz);
        EXPECT_EQ(haptoflow_engine_step(open.engine), HAPTOFLOW_OK) << message();
        appendChecked(output, part, update);
    }
    std::vector<double> levels;
    const auto window = static_cast<std::size_t>(windowSeconds * sweepOutputHz);
    for (std::size_t begin = 0; begin + window <= output.size(); begin += window) {
        levels.push_back(haptoflow::testing::levelDecibels(std::span(output).subspan(begin, window)));
    }
    return levels;
}

double largestJump(const std::vector<double>& levels, std::size_t first) {
    double largest = 0.0;
    for (std::size_t i = first + 1; i < levels.size(); ++i) {
        largest = std::max(largest, std::abs(levels[i] - levels[i - 1]));
    }
    return largest;
}

class RangeSweepSoundTest : public ::testing::TestWithParam<std::tuple<haptoflow_quality, uint32_t>> {
protected:
    // The level of half a second of noise varies by a decibel; a discontinuity between the two laws would be larger.
    static constexpr double maximumAllowedJumpDecibels = 3.0;
};

TEST_P(RangeSweepSoundTest, TheLevelGrowsWithoutAStepFromRestToTwoMetresPerSecond) {
    const auto& [quality, label] = GetParam();
    const std::vector<double> levels =
        sweptLevels(quality, label, [](float done) { return slidingState(2.0F * done, 1.0F); });
    // From 0.25 m/s on, the speed changes by at most a sixth in half a second.
    EXPECT_LT(largestJump(levels, 6), maximumAllowedJumpDecibels);
    EXPECT_GT(levels.back(), levels[1] + 6.0);
}

TEST_P(RangeSweepSoundTest, TheLevelGrowsWithoutAStepFromNoForceToTenNewtons) {
    const auto& [quality, label] = GetParam();
    const std::vector<double> levels =
        sweptLevels(quality, label, [](float done) { return slidingState(0.12F, 10.0F * done); });
    // From 1.2 N on, the force changes by at most a sixth in half a second.
    EXPECT_LT(largestJump(levels, 6), maximumAllowedJumpDecibels);
    EXPECT_GT(levels.back(), levels[1]);
}

INSTANTIATE_TEST_SUITE_P(OnModel, RangeSweepSoundTest,
                         ::testing::Combine(::testing::Values(HAPTOFLOW_QUALITY_SKETCH, HAPTOFLOW_QUALITY_DRAFT,
                                                              HAPTOFLOW_QUALITY_STANDARD),
                                            ::testing::Values(0U, 7U, 13U)),
                         [](const auto& parameters) {
                             return "ShippedQuality" + std::to_string(std::get<0>(parameters.param)) + "Label" +
                                    std::to_string(std::get<1>(parameters.param));
                         });

}  // namespace
}  // namespace haptoflow::capi::testing
