#include "dsp/limiter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::dsp {
namespace {

double gainDbAt(double frequencyHz) {
    HighPass filter;
    std::vector<float> wave(8000);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] = static_cast<float>(
            std::sin(2.0 * std::numbers::pi * frequencyHz * static_cast<double>(i) / waveformRateHz));
    }
    filter.process(wave);
    double squares = 0.0;
    for (std::size_t i = 4000; i < wave.size(); ++i) {
        squares += static_cast<double>(wave[i]) * static_cast<double>(wave[i]);
    }
    return 10.0 * std::log10(squares / 2000.0);
}

TEST(HighPassTest, TheRecordingsBandIsKeptAndWhatLiesBelowIsRemoved) {
    EXPECT_LT(gainDbAt(4.0), -9.0);
    EXPECT_NEAR(gainDbAt(7.0), -3.0, 0.1);
    EXPECT_GT(gainDbAt(10.0), -1.0);
    EXPECT_NEAR(gainDbAt(20.0), 0.0, 0.1);
    EXPECT_NEAR(gainDbAt(500.0), 0.0, 0.01);
}

TEST(HighPassTest, AConstantDecaysAndTheBlocksDoNotMatter) {
    HighPass whole;
    HighPass cut;
    std::vector<float> wave(1000, 5.0F);
    std::vector<float> pieces = wave;
    whole.process(wave);
    for (std::size_t first = 0; first < pieces.size(); first += 7) {
        cut.process(std::span(pieces).subspan(first, std::min<std::size_t>(7, pieces.size() - first)));
    }
    EXPECT_EQ(wave, pieces);
    EXPECT_NEAR(wave.back(), 0.0F, 1e-4F);
}

TEST(HighPassTest, AfterAResetThePastIsForgotten) {
    HighPass filter;
    std::vector<float> loud(100, 100.0F);
    filter.process(loud);
    filter.reset();
    std::vector<float> silence(100);
    filter.process(silence);
    EXPECT_EQ(std::ranges::count(silence, 0.0F), 100);
}

}  // namespace
}  // namespace haptoflow::dsp
