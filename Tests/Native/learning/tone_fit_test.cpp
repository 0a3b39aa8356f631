#include "learning/tone_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

SpeedBins threeBins() {
    SpeedBins bins;
    bins.edgesMps = {0.05, 0.1};
    bins.centresMps = {0.03, 0.07, 0.15};
    return bins;
}

/// A flat spectrum with a mean square of 1, multiplied by `gainDb` of the frequency.
template <typename Gain>
TextureFigures spectrum(double frames, Gain gainDb) {
    TextureFigures figures;
    figures.frames = frames;
    for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
        figures.power[bin] = std::pow(10.0, 0.1 * gainDb(static_cast<double>(bin) * hertzPerBin)) /
                             static_cast<double>(spectrumBins - 1);
        figures.meanSquare += figures.power[bin];
    }
    return figures;
}

double flat(double) {
    return 0.0;
}

double rising(double hertz) {
    return 3.0 * std::log2(std::max(hertz, 20.0) / 150.0);
}

TEST(ToneFitTest, ATiltIsFoundAndTheNetworksLevelIsKept) {
    const std::vector<TextureFigures> generated(3, spectrum(200.0, flat));
    const std::vector<TextureFigures> recorded(3, spectrum(200.0, rising));
    const ToneFit fit = fitTone(threeBins(), recorded, generated, 950.0);
    ASSERT_EQ(fit.tone.speedsMps.size(), 3U);
    EXPECT_NEAR(fit.tone.gainDb(0.07, 400.0) - fit.tone.gainDb(0.07, 100.0), 6.0, 0.5);
    double power = 0.0;
    for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
        power += generated[1].power[bin] *
                 std::pow(10.0, 0.1 * fit.tone.gainDb(0.07, static_cast<double>(bin) * hertzPerBin));
    }
    EXPECT_NEAR(power, 1.0, 0.01);
    for (const double logLevel : fit.logLevels) {
        EXPECT_NEAR(logLevel, 0.0, 0.01);
    }
}

TEST(ToneFitTest, TheLevelOfANetworkThatIsTooQuietIsRaised) {
    const std::vector<TextureFigures> generated(3, spectrum(200.0, [](double) { return -6.0; }));
    const std::vector<TextureFigures> recorded(3, spectrum(200.0, flat));
    for (const double logLevel : fitTone(threeBins(), recorded, generated, 950.0).logLevels) {
        EXPECT_NEAR(8.686 * logLevel, 6.0, 0.1);
    }
}

TEST(ToneFitTest, ASpeedWithFewFramesIsShrunkTowardsTheOthers) {
    const std::vector<TextureFigures> generated(3, spectrum(400.0, flat));
    const auto outlier = [](double hertz) { return hertz > 180.0 && hertz < 230.0 ? 5.0 : 0.0; };
    std::vector<TextureFigures> recorded(3, spectrum(400.0, flat));
    const auto gainOf = [&](double frames) {
        recorded[1] = spectrum(frames, outlier);
        const ToneFit fit = fitTone(threeBins(), recorded, generated, 950.0);
        return fit.tone.gainDb(0.07, 201.587) - fit.tone.gainDb(0.07, 500.0);
    };
    EXPECT_GT(gainOf(400.0), 3.0);
    EXPECT_LT(gainOf(4.0), 0.8 * gainOf(400.0));
}

TEST(ToneFitTest, SpeedsWithoutFramesAreExcludedAndGainsAreWithinTheFilesLimits) {
    std::vector<TextureFigures> recorded(3, spectrum(100.0, [](double hertz) { return hertz < 300.0 ? 90.0 : -90.0; }));
    recorded[0].frames = 0.0;
    const std::vector<TextureFigures> generated(3, spectrum(100.0, flat));
    const ToneFit fit = fitTone(threeBins(), recorded, generated, 950.0);
    ASSERT_EQ(fit.tone.speedsMps.size(), 2U);
    EXPECT_LE(fit.tone.frequenciesHz.size(), 32U);
    for (const std::vector<double>& row : fit.tone.gainsDb) {
        EXPECT_LE(*std::ranges::max_element(row), 30.0);
        EXPECT_GE(*std::ranges::min_element(row), -30.0);
    }
}

TEST(ToneFitTest, TheLastGainIsUsedBeyondTheRecordingsBand) {
    const std::vector<TextureFigures> figures(3, spectrum(100.0, flat));
    const ToneFit fit = fitTone(threeBins(), figures, figures, 475.0);
    EXPECT_NEAR(fit.tone.frequenciesHz.back(), 475.0, 1e-9);
    EXPECT_DOUBLE_EQ(fit.tone.gainDb(0.07, 900.0), fit.tone.gainDb(0.07, 475.0));
}

}  // namespace
}  // namespace haptoflow::learning
