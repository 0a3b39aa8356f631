#include "learning/level_law.hpp"

#include "learning/comparison.hpp"
#include "learning/learner.hpp"
#include "learning/made_recording.hpp"
#include "learning/sliding.hpp"
#include "learning/texture_figures.hpp"
#include "model/material_file.hpp"
#include "support/model_generator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

namespace haptoflow::learning {
namespace {

using testing::MadeMotion;
using testing::MadeRecording;
using testing::MadeSurface;

constexpr double decibelsPerNat = 8.685889638065037;

LevelLaw lawOf(const MadeRecording& made, const ExponentPrior& prior = {}) {
    const recordings::PreparedRecording recording = recordings::prepareRecording(made.view());
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    return fitLevelLaw(recording, findSliding(recording, header), prior);
}

double errorDb(const LevelLaw& law, const MadeSurface& surface, double speed, double force) {
    const double step = surface.stepMps > 0.0 && speed > surface.stepMps ? surface.stepGain : 1.0;
    const double truth = std::log(surface.levelAtReference * step) + surface.speedExponent * std::log(speed / 0.1) +
                         surface.forceExponent * std::log(force);
    return decibelsPerNat * (law.logLevel(speed, force) - truth);
}

TEST(LevelLawTest, APowerLawIsFoundWithinHalfADecibelAndContinuesBeyondTheRecordedSpeeds) {
    const MadeSurface surface{.speedExponent = 0.7, .forceExponent = 0.35};
    const LevelLaw law = lawOf(MadeRecording(surface, {}));
    for (const double speed : {0.035, 0.06, 0.1, 0.2}) {
        EXPECT_NEAR(errorDb(law, surface, speed, 0.9), 0.0, 0.8) << speed;
    }
    EXPECT_NEAR(law.speedExponent, 0.7, 0.12);
    EXPECT_NEAR(law.table.forceExponent, 0.35, 0.15);
    EXPECT_NEAR(errorDb(law, surface, 0.5, 0.9), 0.0, 2.0);
}

TEST(LevelLawTest, AJumpOf14DecibelsIsFollowedInsideTheRecordedRange) {
    const MadeSurface surface{.stepMps = 0.07, .stepGain = 5.0};
    const LevelLaw law = lawOf(MadeRecording(surface, {}));
    EXPECT_NEAR(errorDb(law, surface, 0.045, 0.8), 0.0, 1.5);
    EXPECT_NEAR(errorDb(law, surface, 0.12, 0.8), 0.0, 1.5);
}

TEST(LevelLawTest, TheLevelIsThePowerAlsoWhereItComesInBursts) {
    recordings::PreparedRecording recording;
    recording.wave.resize(40'000);
    skeleton::fillStandardNormal({.seed = 2, .voice = 0, .segment = 0}, recording.wave);
    double power = 0.0;
    for (std::size_t i = 0; i < recording.wave.size(); ++i) {
        const bool isLoud = i / 100 % 10 == 0;
        recording.wave[i] *= isLoud ? 4.0F : 1.0F;
        power += std::pow(static_cast<double>(recording.wave[i]), 2.0) / static_cast<double>(recording.wave.size());
    }
    recording.motion.assign(recording.wave.size(), {0.1F, 0.0F, 1.0F});
    recording.isUsable.assign(recording.wave.size(), 1);
    model::ModelHeader header;
    header.speedMps.maximum = 1.5;
    const LevelLaw law = fitLevelLaw(recording, findSliding(recording, header), {});
    EXPECT_NEAR(decibelsPerNat * (law.logLevel(0.1, 1.0) - 0.5 * std::log(power)), 0.0, 0.5);
}

TEST(LevelLawTest, WithOneSpeedTheExponentsAreThoseOfThePrior) {
    MadeRecording made({.speedExponent = 0.0}, {.minimumSpeedMps = 0.08, .maximumSpeedMps = 0.0801});
    const LevelLaw law = lawOf(made, {.speedMean = 0.75, .speedSpread = 0.1, .forceMean = 0.2, .forceSpread = 0.1});
    EXPECT_EQ(law.table.speedsMps.size(), 1U);
    EXPECT_NEAR(law.speedExponent, 0.75, 0.05);
    EXPECT_NEAR(law.table.speedsMps[0], 0.08, 0.002);
}

TEST(LevelLawTest, TheTableIsWithinTheMaterialFilesLimits) {
    const LevelLaw law = lawOf(MadeRecording({}, {.seconds = 60.0, .minimumSpeedMps = 0.006, .maximumSpeedMps = 1.0}));
    EXPECT_LE(law.table.speedsMps.size(), 16U);
    EXPECT_TRUE(std::ranges::is_sorted(law.table.speedsMps));
    EXPECT_EQ(law.table.speedsMps.size(), law.table.logLevels.size());
}

using ::testing::HasSubstr;

Sliding slidingOf(std::array<double, 3> speeds, std::array<double, 3> forces, double seconds) {
    Sliding sliding;
    sliding.speedMps = speeds;
    sliding.forceNewtons = forces;
    sliding.seconds = seconds;
    return sliding;
}

TEST(RecordNextTest, TheWidestGapIsNamedAndAFullRecordingNeedsNothing) {
    const ExponentPrior prior;
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.05, 0.09}, {0.3, 1.0, 2.0}, 30.0), prior),
                HasSubstr("faster strokes, up to 300 mm/s: above 90 mm/s"));
    EXPECT_THAT(recordNext(slidingOf({0.1, 0.15, 0.3}, {0.3, 1.0, 2.0}, 30.0), prior),
                HasSubstr("slower strokes, down to 20 mm/s: below 100 mm/s"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {0.3, 0.4, 0.5}, 30.0), prior), HasSubstr("press harder"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {1.5, 1.7, 2.0}, 30.0), prior), HasSubstr("press less"));
    EXPECT_THAT(recordNext(slidingOf({0.02, 0.1, 0.3}, {0.3, 1.0, 2.0}, 8.0), prior), HasSubstr("more of the same"));
    EXPECT_EQ(recordNext(slidingOf({0.018, 0.1, 0.32}, {0.28, 1.0, 2.1}, 30.0), prior), "");
}

TEST(RecordNextTest, WhatIsAdvisedGainsMoreThanMoreOfTheSame) {
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    const auto generator = haptoflow::testing::generatorOf(model, 64, "sketch");
    // Above 120 mm/s the surface is four times as strong, which nobody can guess from slower strokes.
    const testing::MadeSurface surface{.stepMps = 0.12, .stepGain = 4.0};
    const auto learnt = [&](double seconds, double fastestMps) {
        const testing::MadeRecording made(surface,
                                          {.seconds = seconds, .minimumSpeedMps = 0.03, .maximumSpeedMps = fastestMps});
        return learnMaterial(made.view(), model, *generator, testing::briefSettings(1000));
    };
    const auto errorDb = [&](const LearntMaterial& material) {
        const model::Label label = model::parseMaterial(material.materialJson).label;
        const double found = label.level->logLevel(0.25, 1.0, label.speedLevelExponent);
        const double wanted = surface.levelAtReference * std::pow(0.25 / 0.1, surface.speedExponent) * surface.stepGain;
        return std::abs(decibelsPerNat * (found - std::log(wanted)));
    };
    const LearntMaterial first = learnt(10.0, 0.08);
    ASSERT_THAT(first.report.recordNext, HasSubstr("faster"));
    const double same = errorDb(learnt(20.0, 0.08));
    const double advised = errorDb(learnt(20.0, 0.3));
    EXPECT_GT(errorDb(first), 6.0);
    EXPECT_GT(same, 6.0);
    EXPECT_LT(advised, 3.0);
}

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
