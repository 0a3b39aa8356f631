#include "learning/texture_figures.hpp"

#include "learning/comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace haptoflow::learning {
namespace {

constexpr double speedMps = 0.1;

/// Frames of Gaussian noise of unit level, and of ribs with `ribsPerMillimetre` whose partials have half of its power.
std::vector<SpectrumFrame> noiseFrames(std::size_t count, double ribsPerMillimetre = 0.0) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    std::vector<SpectrumFrame> frames(count);
    for (std::size_t k = 0; k < count; ++k) {
        frames[k].speedMps = speedMps;
        frames[k].forceNewtons = 1.0;
        frames[k].first = k * spectrumSamples;
        for (std::size_t i = 0; i < spectrumSamples; ++i) {
            const double millimetres = 1000.0 * speedMps * static_cast<double>(frames[k].first + i) / 2000.0;
            const double rib = ribsPerMillimetre > 0.0
                                   ? std::cos(2.0 * std::numbers::pi * ribsPerMillimetre * millimetres + 0.4)
                                   : 0.0;
            frames[k].wave[i] = normal(random) + static_cast<float>(rib);
        }
    }
    return frames;
}

std::vector<RibTravel> travelsOf(std::size_t samples, double ribsPerMillimetre) {
    std::vector<RibTravel> travels(samples);
    for (std::size_t i = 0; i < samples; ++i) {
        travels[i][0] = ribsPerMillimetre * 1000.0 * speedMps * static_cast<double>(i) / 2000.0;
    }
    return travels;
}

WaveFigures figures(std::span<const SpectrumFrame> frames, const model::ToneTable* tone,
                    std::span<const RibTravel> travels, double levelMps2 = 1.0) {
    const std::vector<double> levels(frames.size(), levelMps2);
    return figuresOf(momentsOf(frames, tone, travels), levels, [](std::size_t) { return true; });
}

TEST(FrameFiguresTest, GaussianNoiseHasKurtosisThreeAndItsLevel) {
    const WaveFigures found = figures(noiseFrames(200), nullptr, {}, 2.0);
    EXPECT_EQ(found.frames, 200U);
    EXPECT_NEAR(found.rmsMps2, 2.0, 0.05);
    EXPECT_NEAR(found.kurtosis.value(), 3.0, 0.15);
    EXPECT_FALSE(found.ribsDb[0].has_value());
}

TEST(FrameFiguresTest, KnocksRaiseTheKurtosis) {
    std::vector<SpectrumFrame> frames = noiseFrames(100);
    for (SpectrumFrame& frame : frames) {
        frame.wave[spectrumSamples / 2] = 12.0F;
    }
    EXPECT_GT(figures(frames, nullptr, {}).kurtosis.value(), 10.0);
}

TEST(FrameFiguresTest, RibsHaveTheirShareOfThePowerAndNoiseHasNone) {
    const double ribsPerMillimetre = 0.8;
    const std::vector<RibTravel> travels = travelsOf(200 * spectrumSamples, ribsPerMillimetre);
    // A cosine has half the power of the noise, and a third of the whole.
    EXPECT_NEAR(figures(noiseFrames(200, ribsPerMillimetre), nullptr, travels).ribsDb[0].value(),
                10.0 * std::log10(1.0 / 3.0), 0.4);
    EXPECT_LT(figures(noiseFrames(200), nullptr, travels).ribsDb[0].value(), -17.0);
}

TEST(FrameFiguresTest, RibsThatPassTooSlowlyAreNotTold) {
    const std::vector<RibTravel> travels = travelsOf(10 * spectrumSamples, 0.2);
    EXPECT_FALSE(figures(noiseFrames(10, 0.2), nullptr, travels).ribsDb[0].has_value());
}

TEST(FrameFiguresTest, ATonesGainRaisesLevelAndRibsAlike) {
    const model::ToneTable tone{
        .speedsMps = {0.1}, .forcesNewtons = {1.0}, .frequenciesHz = {20.0, 900.0}, .gainsDb = {{6.0, 6.0}}};
    const std::vector<RibTravel> travels = travelsOf(200 * spectrumSamples, 0.8);
    const std::vector<SpectrumFrame> frames = noiseFrames(200, 0.8);
    const WaveFigures without = figures(frames, nullptr, travels);
    const WaveFigures with = figures(frames, &tone, travels);
    EXPECT_NEAR(with.rmsMps2 / without.rmsMps2, 1.995, 0.01);
    EXPECT_NEAR(with.ribsDb[0].value(), without.ribsDb[0].value(), 0.05);
    EXPECT_NEAR(with.kurtosis.value(), without.kurtosis.value(), 0.01);
}

TEST(ForceRangesTest, ForcesThatDifferAreDividedAndOneForceIsNot) {
    std::vector<SpectrumFrame> frames = noiseFrames(190);
    EXPECT_EQ(ForceRanges::divide(frames).meansNewtons.size(), 1U);
    for (std::size_t k = 0; k < frames.size(); ++k) {
        frames[k].forceNewtons = k % 2 == 0 ? 0.5 : 1.5;
    }
    const ForceRanges two = ForceRanges::divide(frames);
    ASSERT_EQ(two.meansNewtons.size(), 2U);
    EXPECT_NEAR(two.meansNewtons[0], 0.5, 1e-6);
    EXPECT_NEAR(two.meansNewtons[1], 1.5, 1e-6);
    EXPECT_EQ(two.rangeOf(0.5), 0U);
    EXPECT_EQ(two.rangeOf(1.5), 1U);
    EXPECT_EQ(ForceRanges::divide(std::span(frames).first(60)).meansNewtons.size(), 1U) << "too few frames";
}

}  // namespace
}  // namespace haptoflow::learning
