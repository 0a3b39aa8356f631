#include "engine/waveform_timeline.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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

}  // namespace
}  // namespace haptoflow::engine
