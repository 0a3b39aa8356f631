#include "learning/texture_fit.hpp"

#include "learning/made_recording.hpp"
#include "learning/tone_fit.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace haptoflow::learning {
namespace {

/// Gives back the noise and remembers the motions.
class NoiseGenerator final : public inference::SegmentGenerator {
public:
    void levels(std::span<const inference::SegmentRequest>, std::span<float> levelsMps2) override {
        std::ranges::fill(levelsMps2, 1.0F);
    }
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        for (const inference::SegmentRequest& request : requests) {
            motions.push_back(request.motion);
            std::ranges::copy(request.noise, segments.begin());
            segments = segments.subspan(inference::segmentSamples);
        }
    }
    std::vector<std::array<float, 3>> motions;
};

TEST(TextureFitTest, SteadyFramesHaveEverySpeedAndForceInTheRecordedDirections) {
    const testing::MadeRecording made({}, {.cycles = false});
    const recordings::PreparedRecording recording = recordings::prepareRecording(made.view());
    model::ModelHeader header;
    header.speedMps.maximum = 1.0;
    header.forceNewtons = {.minimum = 0.0, .maximum = 20.0};
    const Sliding sliding = findSliding(recording, header);
    NoiseGenerator generator;
    ClosedLoop loop(generator, header, recording, recording.wave);
    const std::array<float, 2 * inference::ribCount> noRibs{};
    TextureFit fit(loop, recording, sliding, recording.wave, noRibs, 1);
    const std::array speeds{0.02, 0.3};
    const std::array forces{0.4, 1.0, 2.5};
    const std::vector<SpectrumFrame> frames = fit.steadyFrames({}, speeds, forces, 3000, 1.0F);
    for (const double speed : speeds) {
        for (const double force : forces) {
            const auto isHere = [&](const SpectrumFrame& frame) {
                return std::abs(frame.speedMps - speed) < 1e-6 && std::abs(frame.forceNewtons - force) < 1e-6;
            };
            EXPECT_EQ(std::ranges::count_if(frames, isHere) * 6, static_cast<std::ptrdiff_t>(frames.size()));
        }
    }
    ASSERT_FALSE(generator.motions.empty());
    for (const std::array<float, 3>& motion : generator.motions) {
        EXPECT_LT(std::abs(motion[1]), 0.01F * std::abs(motion[0]));
    }
    EXPECT_LE(generator.motions.size(), 3000U);
    double power = 0.0;
    for (const SpectrumFrame& frame : frames) {
        for (const double each : frame.power) {
            power += each / static_cast<double>(frames.size());
        }
    }
    EXPECT_NEAR(power, 1.0, 0.05);
}

constexpr double flatPower = 1.0 / static_cast<double>(spectrumBins - 1);

/// Frames of Gaussian noise whose spectrum is `gainDb(speed, force, hertz)`, at speeds from 20 to 200 mm/s and forces
/// from 0.4 to 2 N.
template <typename Gain>
std::vector<SpectrumFrame> framesOf(std::size_t count, Gain gainDb, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::exponential_distribution<double> chance(1.0);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    std::vector<SpectrumFrame> frames(count);
    for (SpectrumFrame& frame : frames) {
        frame.speedMps = 0.02 * std::pow(10.0, share(random));
        frame.forceNewtons = 0.4 * std::pow(5.0, share(random));
        for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
            const double hertz = static_cast<double>(bin) * hertzPerBin;
            frame.power[bin] =
                flatPower * std::pow(10.0, 0.1 * gainDb(frame.speedMps, frame.forceNewtons, hertz)) * chance(random);
        }
    }
    return frames;
}

double flat(double, double, double) {
    return 0.0;
}

/// A bump at 200 Hz that grows with the force, and a tilt that grows with the speed.
double livelySpectrum(double speed, double force, double hertz) {
    const double away = std::log2(hertz / 200.0) / 0.5;
    return 6.0 * std::log2(force) * std::exp(-0.5 * away * away) +
           2.0 * std::log(speed / 0.06) * std::log2(hertz / 150.0);
}

double rmsErrorDb(const model::ToneTable& tone) {
    std::vector<float> errors;
    for (const double speed : {0.03, 0.06, 0.13}) {
        for (const double force : {0.5, 0.9, 1.6}) {
            const auto error = [&](double hertz) {
                return tone.gainDb(speed, force, hertz) - livelySpectrum(speed, force, hertz);
            };
            for (double hertz = 30.0; hertz < 600.0; hertz *= 1.3) {
                // Both are compared without their mean, which is the level law's.
                errors.push_back(static_cast<float>(error(hertz) - error(100.0)));
            }
        }
    }
    return haptoflow::testing::rms(errors);
}

model::ToneTable fitted(const std::vector<SpectrumFrame>& recorded, const std::vector<SpectrumFrame>& generated,
                        double bandwidthHz = 950.0) {
    return fitTone(recorded, generated, std::nullopt, bandwidthHz);
}

SpeedBins threeBins() {
    SpeedBins bins;
    bins.edgesMps = {0.05, 0.1};
    bins.centresMps = {0.03, 0.07, 0.15};
    return bins;
}

TEST(ToneFitTest, ASpectrumThatChangesWithSpeedAndForceIsFollowedMoreCloselyTheMoreIsRecorded) {
    const auto generated = framesOf(500, flat, 7);
    const double few = rmsErrorDb(fitted(framesOf(80, livelySpectrum), generated));
    const double many = rmsErrorDb(fitted(framesOf(900, livelySpectrum), generated));
    EXPECT_LT(few, 2.5);
    EXPECT_LT(many, 1.2);
    EXPECT_LT(many, few);
}

TEST(ToneFitTest, ChanceInTheFramesIsNotTakenForATone) {
    for (unsigned seed = 1; seed <= 5; ++seed) {
        const model::ToneTable tone = fitted(framesOf(60, flat, seed), framesOf(500, flat, 100 + seed));
        std::vector<float> gains;
        for (const std::vector<double>& row : tone.gainsDb) {
            gains.insert(gains.end(), row.begin(), row.end());
        }
        EXPECT_LT(haptoflow::testing::rms(gains), 1.0) << "seed " << seed;
    }
}

TEST(ToneFitTest, ANetworkThatIsTooQuietAtEverySpeedIsRaised) {
    const auto quiet = framesOf(
        500, [](double speed, double, double) { return -6.0 - 20.0 * speed; }, 3);
    const auto recorded = framesOf(300, flat, 4);
    const model::ToneTable tone = fitted(recorded, quiet);
    EXPECT_NEAR(tone.gainDb(0.025, 0.9, 200.0), 6.5, 0.7);
    EXPECT_NEAR(tone.gainDb(0.15, 0.9, 200.0), 9.0, 0.7);
    EXPECT_LT(std::abs(toneErrors(threeBins(), recorded, quiet, tone).levelErrorDb), 0.7);
}

TEST(ToneFitTest, TheLevelIsThatOfTheNetworkInTheTablesConditionsAndTheShapeThatAlongTheRecordedMotion) {
    const auto recorded = framesOf(300, flat, 4);
    const auto tilted = framesOf(
        500, [](double, double, double hertz) { return hertz < 300.0 ? -6.0 : 0.0; }, 3);
    const auto loud = framesOf(
        500, [](double, double, double hertz) { return hertz < 300.0 ? 4.0 : 10.0; }, 6);
    const model::ToneTable tone = fitTone(recorded, loud, tilted, 950.0);
    EXPECT_NEAR(tone.gainDb(0.07, 0.9, 150.0) - tone.gainDb(0.07, 0.9, 600.0), 6.0, 1.5);
    EXPECT_LT(std::abs(toneErrors(threeBins(), recorded, loud, tone).levelErrorDb), 0.7);
}

TEST(ToneFitTest, ARecordingAtOneForceGivesAToneWithoutForces) {
    auto recorded = framesOf(200, livelySpectrum);
    std::ranges::for_each(recorded, [](SpectrumFrame& frame) { frame.forceNewtons = 1.0; });
    auto generated = framesOf(200, flat, 9);
    std::ranges::for_each(generated, [](SpectrumFrame& frame) { frame.forceNewtons = 1.0; });
    const model::ToneTable tone = fitted(recorded, generated);
    ASSERT_EQ(tone.forcesNewtons.size(), 1U);
    EXPECT_NEAR(tone.forcesNewtons[0], 1.0, 1e-9);
    EXPECT_EQ(tone.gainsDb.size(), tone.speedsMps.size());
}

TEST(ToneFitTest, GainsStayWithinTheFilesLimitsAndTooFewFramesGiveNoTone) {
    const auto generated = framesOf(200, flat, 2);
    const auto split = framesOf(200, [](double, double, double hertz) { return hertz < 300.0 ? 90.0 : -90.0; });
    const model::ToneTable tone = fitted(split, generated);
    EXPECT_LE(tone.frequenciesHz.size(), model::ToneTable::maximumFrequencies);
    for (const std::vector<double>& row : tone.gainsDb) {
        EXPECT_LE(*std::ranges::max_element(row), 30.0);
        EXPECT_GE(*std::ranges::min_element(row), -30.0);
    }
    EXPECT_TRUE(fitted(framesOf(3, flat), generated).speedsMps.empty());
}

TEST(ToneFitTest, TheLastGainIsUsedBeyondTheRecordingsBand) {
    const model::ToneTable tone = fitted(framesOf(100, livelySpectrum), framesOf(100, flat, 5), 475.0);
    EXPECT_LE(tone.frequenciesHz.back(), 475.0);
    EXPECT_GT(tone.frequenciesHz.back(), 460.0);
    EXPECT_DOUBLE_EQ(tone.gainDb(0.07, 1.0, 900.0), tone.gainDb(0.07, 1.0, tone.frequenciesHz.back()));
}

TEST(ToneFitTest, ErrorsTellHowFarTheNetworkIsOffAndInWhichDirection) {
    const auto recorded = framesOf(2000, flat, 11);
    const model::ToneTable none{.speedsMps = {0.1}, .frequenciesHz = {50.0, 500.0}, .gainsDb = {{0.0, 0.0}}};
    const auto same = toneErrors(threeBins(), recorded, framesOf(2000, flat, 12), none);
    EXPECT_LT(same.spectralDistanceDb, 0.4);
    EXPECT_LT(std::abs(same.levelErrorDb), 0.2);
    const auto quiet = toneErrors(threeBins(), recorded,
                                  framesOf(
                                      2000, [](double, double, double) { return -4.0; }, 13),
                                  none);
    EXPECT_NEAR(quiet.levelErrorDb, -4.0, 0.2);
    EXPECT_NEAR(quiet.spectralDistanceDb, 4.0, 0.2);
}

}  // namespace
}  // namespace haptoflow::learning
