#include "engine/waveform_timeline.hpp"

#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace haptoflow::engine {
namespace {

/// The gains of `count` samples from `start` on.
std::vector<float> gains(LevelFollower& follower, std::int64_t start, std::size_t count) {
    std::vector<float> samples(count, 1.0F);
    follower.process(start, samples);
    return samples;
}

TEST(LevelFollowerTest, ASegmentOfTheNewestStateIsPlayedUnchanged) {
    LevelFollower follower;
    follower.begin(100, 0.37F);
    follower.setLevel(0.37F);
    for (const float gain : gains(follower, 100, 50)) {
        ASSERT_EQ(gain, 1.0F);
    }
}

TEST(LevelFollowerTest, ANewLevelIsReachedWithinFourMillisecondsAlongARamp) {
    LevelFollower follower;
    follower.begin(0, 1.0F);
    follower.setLevel(2.0F);
    const std::vector<float> found = gains(follower, 0, 12);
    EXPECT_NEAR(found[0], std::exp2(0.125F), 1e-5F);
    for (std::size_t i = 1; i < 8; ++i) {
        EXPECT_NEAR(found[i] / found[i - 1], std::exp2(0.125F), 1e-4F);
    }
    EXPECT_NEAR(found[8], 2.0F, 1e-5F);
    EXPECT_NEAR(found[11], 2.0F, 1e-5F);
}

TEST(LevelFollowerTest, WhereASegmentTakesOverLevelAndGainChangeTogether) {
    LevelFollower follower;
    follower.begin(0, 1.0F);
    follower.setLevel(3.0F);
    (void)gains(follower, 0, 20);
    follower.takeOver(30, 3.0F);
    const std::vector<float> found = gains(follower, 20, 20);
    EXPECT_NEAR(found[9], 3.0F, 1e-4F);
    EXPECT_NEAR(found[10], 1.0F, 1e-5F);
    EXPECT_NEAR(found[19], 1.0F, 1e-5F);
}

TEST(LevelFollowerTest, TheGainStaysWithinTwelveDecibelsUpAndFortyDown) {
    LevelFollower follower;
    follower.begin(0, 0.001F);
    follower.setLevel(1000.0F);
    EXPECT_NEAR(gains(follower, 0, 20)[19], 3.981F, 1e-3F);
    follower.begin(0, 1000.0F);
    follower.setLevel(0.0F);
    EXPECT_NEAR(gains(follower, 0, 20)[19], 0.01F, 1e-4F);
}

TEST(LevelFollowerTest, LevelsOfNoUseLeaveTheOutputFinite) {
    LevelFollower follower;
    for (const float level : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -1.0F}) {
        follower.begin(0, level);
        follower.setLevel(level);
        follower.takeOver(5, level);
        follower.setLevel(1.0F);
        for (const float gain : gains(follower, 0, 20)) {
            ASSERT_TRUE(std::isfinite(gain)) << level;
        }
    }
}

TEST(LevelFollowerTest, BlocksOfAnyLengthGiveTheSameGains) {
    std::array<std::vector<float>, 2> found;
    for (std::size_t run = 0; run < 2; ++run) {
        LevelFollower follower;
        follower.begin(0, 1.0F);
        std::int64_t start = 0;
        for (const float level : {1.5F, 0.3F, 0.9F}) {
            follower.setLevel(level);
            follower.takeOver(start + 7, level);
            for (std::size_t done = 0; done < 30;) {
                const std::size_t count = run == 0 ? 30 : std::min<std::size_t>(4, 30 - done);
                for (const float gain : gains(follower, start, count)) {
                    found[run].push_back(gain);
                }
                done += count;
                start += static_cast<std::int64_t>(count);
            }
        }
    }
    EXPECT_EQ(found[0], found[1]);
}

TEST(LevelFollowerTest, AHundredSegmentsAheadOfTheHeadAreKeptWithinTheRoom) {
    LevelFollower follower;
    follower.begin(0, 1.0F);
    follower.setLevel(1.0F);
    for (std::int64_t start = 10; start <= 1000; start += 10) {
        follower.takeOver(start, 2.0F);
    }
    const std::vector<float> found = gains(follower, 0, 1200);
    EXPECT_NEAR(found[1100], 0.5F, 1e-5F);
}

}  // namespace
}  // namespace haptoflow::engine
