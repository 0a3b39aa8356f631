#include "engine/seam_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace haptoflow::engine {
namespace {

std::vector<float> ramp(std::size_t count) {
    std::vector<float> wave(count);
    for (std::size_t i = 0; i < count; ++i) {
        wave[i] = 0.01F * static_cast<float>(i);
    }
    return wave;
}

/// Feeds a whole waveform to a SeamMeter; `seams` are indices into it, ascending.
SeamStatistics measureSeams(std::span<const float> waveform, std::span<const std::int64_t> seams,
                            std::size_t spliceSamples) {
    SeamMeter meter(spliceSamples);
    for (const std::int64_t seam : seams) {
        if (seam < static_cast<std::int64_t>(waveform.size())) {
            meter.addSeam(seam);
        }
    }
    meter.addSamples(waveform);
    return meter.statistics();
}

TEST(SeamStatisticsTest, SeamsInAConstantSlopeAreNotOutliers) {
    const std::vector<std::int64_t> seams{100, 200, 300};
    const SeamStatistics statistics = measureSeams(ramp(1000), seams, 4);
    EXPECT_EQ(statistics.seams, 3U);
    EXPECT_NEAR(statistics.jumpRatio, 1.0, 1e-3);
}

TEST(SeamStatisticsTest, AStepAtEverySeamRaisesJumpRatioAndOutlierShare) {
    std::vector<float> wave = ramp(20000);
    std::vector<std::int64_t> seams;
    for (std::int64_t seam = 500; seam < 20000; seam += 5000) {
        seams.push_back(seam);
        for (std::size_t i = static_cast<std::size_t>(seam); i < wave.size(); ++i) {
            wave[i] += 1.0F;
        }
    }
    const SeamStatistics statistics = measureSeams(wave, seams, 1);
    EXPECT_NEAR(statistics.jumpRatio, 101.0, 0.5);
    EXPECT_EQ(statistics.outlierShare, 1.0);
}

TEST(SeamStatisticsTest, PiecesGiveTheSameStatisticsAsTheWhole) {
    std::vector<float> wave = ramp(5000);
    std::vector<std::int64_t> seams;
    for (std::int64_t seam = 10; seam < 4990; seam += 37) {
        seams.push_back(seam);
        wave[static_cast<std::size_t>(seam)] += 0.0001F * static_cast<float>(seam);
    }
    const SeamStatistics whole = measureSeams(wave, seams, 4);
    SeamMeter meter(4);
    std::size_t announced = 0;
    for (std::size_t begin = 0; begin < wave.size(); begin += 13) {
        const std::size_t end = std::min(begin + 13, wave.size());
        for (; announced < seams.size() && seams[announced] < static_cast<std::int64_t>(end) + 50; ++announced) {
            meter.addSeam(seams[announced]);
        }
        meter.addSamples(std::span(wave).subspan(begin, end - begin));
    }
    EXPECT_EQ(meter.statistics().seams, whole.seams);
    EXPECT_EQ(meter.statistics().outlierShare, whole.outlierShare);
    EXPECT_EQ(meter.statistics().jumpRatio, whole.jumpRatio);
    EXPECT_GT(whole.outlierShare, 0.0);
}

TEST(SeamStatisticsTest, AnAnnouncedSeamThatWasNotPlayedDoesNotCount) {
    SeamMeter meter(4);
    meter.addSeam(0);
    meter.addSeam(3);
    meter.addSeam(100);
    meter.addSamples(ramp(10));
    EXPECT_EQ(meter.statistics().seams, 1U);
}

TEST(ValueHistogramTest, PercentilesAreExactToATenthOfAPercent) {
    ValueHistogram histogram;
    std::vector<float> values;
    for (int i = 0; i < 10000; ++i) {
        values.push_back(1e-6F * std::pow(1.002F, static_cast<float>((i * 7919) % 10000)));
        histogram.add(values.back());
    }
    std::ranges::sort(values);
    for (const double share : {0.0, 0.001, 0.5, 0.99, 0.999, 1.0}) {
        const float exact = values[static_cast<std::size_t>(share * 9999.0)];
        EXPECT_LE(histogram.valueAtShare(share), exact) << share;
        EXPECT_GT(histogram.valueAtShare(share), exact * 0.999F) << share;
    }
    EXPECT_NEAR(static_cast<double>(histogram.countAbove(values[4999])), 5000.0, 1.0);
}

TEST(ValueHistogramTest, NaNCountsAsZeroAndAnEmptyHistogramGivesZero) {
    ValueHistogram histogram;
    EXPECT_EQ(histogram.valueAtShare(0.5), 0.0F);
    for (const float value : {-1.0F, 0.0F, -0.0F, std::numeric_limits<float>::quiet_NaN()}) {
        histogram.add(value);
    }
    EXPECT_EQ(histogram.valueAtShare(1.0), 0.0F);
    EXPECT_EQ(histogram.countAbove(0.0F), 0U);
    histogram.add(std::numeric_limits<float>::infinity());
    EXPECT_EQ(histogram.countAbove(0.0F), 1U);
    EXPECT_EQ(histogram.count(), 5U);
}

TEST(SeamStatisticsTest, WithoutAWaveOrSeamsTheStatisticsAreZero) {
    const SeamStatistics none = measureSeams({}, {}, 4);
    EXPECT_EQ(none.seams, 0U);
    EXPECT_EQ(none.jumpRatio, 0.0);
    const SeamStatistics noSeams = measureSeams(ramp(10), {}, 4);
    EXPECT_EQ(noSeams.outlierShare, 0.0);
}

}  // namespace
}  // namespace haptoflow::engine
