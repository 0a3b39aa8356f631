#include "engine/seam_statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
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

TEST(SeamStatisticsTest, SeamsInsideAnEvenSlopeDoNotStandOut) {
    const std::vector<std::int64_t> seams{100, 200, 300};
    const SeamStatistics statistics = measureSeams(ramp(1000), seams, 4);
    EXPECT_EQ(statistics.seams, 3U);
    EXPECT_NEAR(statistics.jumpRatio, 1.0, 1e-3);
}

TEST(SeamStatisticsTest, AStepAtEverySeamShowsInRatioAndShare) {
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

TEST(SeamStatisticsTest, WithoutAWaveOrSeamsEverythingIsZero) {
    const SeamStatistics none = measureSeams({}, {}, 4);
    EXPECT_EQ(none.seams, 0U);
    EXPECT_EQ(none.jumpRatio, 0.0);
    const SeamStatistics noSeams = measureSeams(ramp(10), {}, 4);
    EXPECT_EQ(noSeams.outlierShare, 0.0);
}

}  // namespace
}  // namespace haptoflow::engine
