#include "engine/waveform_timeline.hpp"

#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace haptoflow::engine {
namespace {

using Seed = std::array<float, WaveformTimeline::seedSamples>;
using Segment = std::array<float, inference::segmentSamples>;

Seed countingSeed() {
    Seed seed{};
    for (std::size_t i = 0; i < seed.size(); ++i) {
        seed[i] = static_cast<float>(i) + 1.0F;
    }
    return seed;
}

Segment constantSegment(float value) {
    Segment segment{};
    segment.fill(value);
    return segment;
}

std::vector<float> readSamples(WaveformTimeline& timeline, std::size_t count) {
    std::vector<float> samples(count);
    timeline.read(samples);
    return samples;
}

TEST(WaveformTimelineTest, TheSeedsSecondHalfSoundsAndItsFirstHalfIsThePast) {
    WaveformTimeline timeline;
    const Seed seed = countingSeed();
    timeline.open(seed);

    Segment past{};
    timeline.history(timeline.head(), past);
    EXPECT_TRUE(std::equal(past.begin(), past.end(), seed.begin()));
    const std::vector<float> output = readSamples(timeline, 150);
    EXPECT_TRUE(std::equal(output.begin(), output.end(), seed.begin() + 200));
}

TEST(WaveformTimelineTest, ASegmentThatContinuesTheRunningOneChangesNothing) {
    WaveformTimeline timeline;
    const Seed seed = countingSeed();
    timeline.open(seed);
    Segment continuation{};
    for (std::size_t i = 0; i < continuation.size(); ++i) {
        continuation[i] = static_cast<float>(i) + 251.0F;
    }
    const std::int64_t start = timeline.head() + 50;
    EXPECT_EQ(timeline.commit(start, continuation), start);

    const std::vector<float> output = readSamples(timeline, 200);
    for (std::size_t i = 0; i < output.size(); ++i) {
        ASSERT_EQ(output[i], static_cast<float>(i) + 201.0F) << "sample " << i;
    }
}

/// Waves with different numbers are uncorrelated except for their first sample, which all of them share.
Segment unlikeSegment(int number) {
    Segment segment{};
    for (std::size_t i = 0; i < segment.size(); ++i) {
        const auto turn = static_cast<double>(i * static_cast<std::size_t>(number + 3) * 37 % 101);
        segment[i] = i == 0 ? 1.0F : static_cast<float>(std::sin(turn));
    }
    return segment;
}

/// A second of a touch in which the callback reads nothing until `replaced` segments have arrived for one start.
std::vector<float> playedAfterReplacing(std::int64_t ahead, int replaced, bool isViewedBetween) {
    WaveformTimeline timeline;
    Seed seed{};
    std::ranges::copy(unlikeSegment(50), seed.begin());
    std::ranges::copy(unlikeSegment(51), seed.begin() + 200);
    timeline.open(seed);
    readSamples(timeline, 20);
    const std::int64_t start = timeline.head() + ahead;
    for (int number = replaced - 1; number >= 0; --number) {
        EXPECT_EQ(timeline.commit(start, unlikeSegment(number)), start);
        if (isViewedBetween) {
            TimelineView view;
            timeline.view(view);
            WaveformTimeline other;
            other.restore(view);
            timeline = other;
        }
    }
    return readSamples(timeline, 150);
}

TEST(WaveformTimelineTest, OfSegmentsWithOneStartOnlyTheLastIsSplicedWithTheWaveBefore) {
    for (const std::int64_t ahead : {0, 1, 70}) {
        const std::vector<float> last = playedAfterReplacing(ahead, 1, false);
        EXPECT_EQ(playedAfterReplacing(ahead, 2, false), last) << ahead;
        EXPECT_EQ(playedAfterReplacing(ahead, 12, false), last) << ahead;
        EXPECT_EQ(playedAfterReplacing(ahead, 12, true), last) << ahead << ", viewed by another thread";
    }
}

TEST(WaveformTimelineTest, ASegmentForAPlayedStartIsSplicedWithThePlayedWave) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    const std::int64_t start = timeline.head();
    timeline.commit(start, constantSegment(5.0F));
    readSamples(timeline, 10);
    timeline.commit(start, constantSegment(5.0F));
    for (const float sample : readSamples(timeline, 150)) {
        ASSERT_EQ(sample, 5.0F);
    }
}

TEST(WaveformTimelineTest, TheHistoryIncludesCommittedSamplesNotYetPlayed) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    Segment past{};
    timeline.history(timeline.head() + 30, past);
    EXPECT_EQ(past.front(), 31.0F);
    EXPECT_EQ(past.back(), 230.0F);
}

TEST(WaveformTimelineTest, ALateSegmentLosesTheSamplesThatTheHeadHasPassed) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    const std::int64_t start = timeline.head() + 10;
    readSamples(timeline, 25);
    Segment late{};
    for (std::size_t i = 0; i < late.size(); ++i) {
        late[i] = 1000.0F + static_cast<float>(i);
    }
    EXPECT_EQ(timeline.commit(start, late), timeline.head());
    EXPECT_EQ(timeline.coveredUntil(), start + 200);
    const std::vector<float> output = readSamples(timeline, 20);
    EXPECT_EQ(output[10], 1025.0F);
}

TEST(WaveformTimelineTest, ASegmentWhollyInThePastIsRejected) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    const std::int64_t start = timeline.head() - 60;
    readSamples(timeline, 150);
    const std::int64_t covered = timeline.coveredUntil();
    EXPECT_EQ(timeline.commit(start, constantSegment(9.0F)), -1);
    EXPECT_EQ(timeline.coveredUntil(), covered);
}

TEST(WaveformTimelineTest, ASegmentThatWouldLeaveAGapIsRejected) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    EXPECT_EQ(timeline.commit(timeline.coveredUntil() + 1, constantSegment(1.0F)), -1);
}

TEST(WaveformTimelineTest, WithoutANewSegmentTheWaveFadesAndMissingSamplesAreCounted) {
    WaveformTimeline timeline;
    Seed seed{};
    seed.fill(1.0F);
    timeline.open(seed);
    const std::vector<float> output = readSamples(timeline, 260);
    EXPECT_EQ(output[189], 1.0F);
    for (std::size_t i = 190; i < output.size(); ++i) {
        ASSERT_LE(std::abs(output[i] - output[i - 1]), 0.1001F) << "sample " << i;
    }
    EXPECT_EQ(output[201], 0.0F);
    EXPECT_EQ(timeline.uncoveredSamples(), 60U);
}

TEST(WaveformTimelineTest, AfterAnUnderrunTheNextSegmentFadesIn) {
    WaveformTimeline timeline;
    Seed seed{};
    seed.fill(1.0F);
    timeline.open(seed);
    readSamples(timeline, 230);
    EXPECT_EQ(timeline.commit(timeline.head() - 5, constantSegment(1.0F)), timeline.head());
    const std::vector<float> output = readSamples(timeline, 30);
    EXPECT_LE(output[0], 0.1001F);
    for (std::size_t i = 1; i < output.size(); ++i) {
        ASSERT_LE(std::abs(output[i] - output[i - 1]), 0.1001F) << "sample " << i;
    }
    EXPECT_EQ(output.back(), 1.0F);
}

TEST(WaveformTimelineTest, TheClockIsExactOverADayOfSegments) {
    WaveformTimeline timeline;
    timeline.open(countingSeed());
    const std::int64_t origin = timeline.head();
    std::vector<float> block(1000);
    constexpr std::int64_t dayOfBlocks = 24LL * 3600 * 2;
    for (std::int64_t i = 0; i < dayOfBlocks; ++i) {
        timeline.read(block);
    }
    EXPECT_EQ(timeline.head() - origin, dayOfBlocks * 1000);
    EXPECT_EQ(timeline.commit(timeline.head(), constantSegment(2.0F)), timeline.head());
    EXPECT_EQ(readSamples(timeline, 100).back(), 2.0F);
}

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
