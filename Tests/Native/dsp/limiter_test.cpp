#include "dsp/limiter.hpp"

#include "dsp/denormals.hpp"
#include "support/wave_measures.hpp"
#include "test_signals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

namespace haptoflow::dsp {
namespace {

using testing::Uniform;

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();

void limit(SoftLimiter& limiter, std::span<float> samples) {
    limiter.scale(samples);
    limiter.processScaled(samples);
}

float limited(SoftLimiter limiter, float mps2) {
    limit(limiter, std::span(&mps2, 1));
    return mps2;
}

TEST(LimiterTest, BelowTheKneeTheCurveIsExactlyLinear) {
    const SoftLimiter limiter(60.0F);
    Uniform uniform(41);
    for (int i = 0; i < 10000; ++i) {
        const auto input = static_cast<float>(uniform(-41.99, 41.99));
        ASSERT_EQ(limited(limiter, input), input / 60.0F);
    }
    EXPECT_EQ(limited(limiter, 30.0F), 0.5F);
    EXPECT_EQ(limited(limiter, 0.0F), 0.0F);
}

TEST(LimiterTest, AboveTheKneeTheCurveIsMonotoneAndStaysBelowOne) {
    const SoftLimiter limiter(1.0F);
    float previous = limited(limiter, 0.6F);
    for (float input = 0.6F; input < 1e30F; input *= 1.0001F) {
        const float output = limited(limiter, input);
        ASSERT_GE(output, previous) << "at " << input;
        ASSERT_LT(output, 1.0F) << "at " << input;
        previous = output;
    }
    EXPECT_GT(previous, 0.999F);
    EXPECT_LT(limited(limiter, std::numeric_limits<float>::max()), 1.0F);
    EXPECT_LT(limited(SoftLimiter(1e-30F), 1e30F), 1.0F) << "the quotient overflows to infinity";
}

TEST(LimiterTest, TheCurveApproachesALowerCeilingSmoothlyWithoutAHardClip) {
    for (const float ceiling : {1e-6F, 0.03F, 0.25F, 0.5F, 0.9F, 1.0F}) {
        SoftLimiter limiter(1.0F);
        limiter.setCeiling(ceiling);
        EXPECT_EQ(limited(limiter, 0.5F * ceiling), 0.5F * ceiling) << "linear below 0.7 of the ceiling";
        float previous = limited(limiter, 0.6F * ceiling);
        double previousSlope = 1.0;
        for (float input = 0.6F * ceiling; input < 20.0F * ceiling; input += 0.01F * ceiling) {
            const float output = limited(limiter, input + 0.01F * ceiling);
            const double slope = (static_cast<double>(output) - previous) / (0.01 * ceiling);
            ASSERT_LT(output, ceiling) << input;
            ASSERT_GT(output, previous) << "a hard clip would be flat at " << input << " under " << ceiling;
            ASSERT_NEAR(slope, previousSlope, 0.08) << "a corner at " << input << " under " << ceiling;
            previous = output;
            previousSlope = slope;
        }
        EXPECT_LT(limited(limiter, infinity / 2.0F), ceiling);
        EXPECT_LT(limited(limiter, std::numeric_limits<float>::max()), ceiling);
    }
}

TEST(LimiterTest, ACeilingOfZeroSilencesAndCeilingsOutsideZeroToOneAreClamped) {
    SoftLimiter limiter(1.0F);
    limiter.setCeiling(0.0F);
    EXPECT_EQ(limited(limiter, 0.0F), 0.0F);
    EXPECT_EQ(limited(limiter, 5.0F), 0.0F);
    EXPECT_EQ(limited(limiter, -1e30F), 0.0F);
    limiter.setCeiling(7.0F);
    EXPECT_LT(limited(limiter, 1e30F), 1.0F);
    EXPECT_EQ(limited(limiter, 0.6F), 0.6F);
    limiter.setCeiling(notANumber);
    EXPECT_EQ(limited(limiter, 0.6F), 0.6F);
    limiter.setCeiling(-2.0F);
    EXPECT_EQ(limited(limiter, 0.6F), 0.0F);
}

TEST(LimiterTest, ValueAndSlopeAreContinuousAtTheKnee) {
    const SoftLimiter limiter(1.0F);
    const double step = 1e-3;
    const auto at = [&](double input) { return static_cast<double>(limited(limiter, static_cast<float>(input))); };
    EXPECT_NEAR(at(0.7 + 1e-6), 0.7, 2e-6);
    const double below = (at(0.7) - at(0.7 - step)) / step;
    const double above = (at(0.7 + step) - at(0.7)) / step;
    EXPECT_NEAR(below, 1.0, 1e-3);
    EXPECT_NEAR(above, 1.0, 5e-3);
}

TEST(LimiterTest, NonFiniteSamplesBecomeZeroAndAreCounted) {
    SoftLimiter limiter(60.0F);
    std::vector<float> samples = {notANumber, 6.0F, infinity, -infinity, 1e30F, -48.0F};
    limit(limiter, samples);
    EXPECT_EQ(samples[0], 0.0F);
    EXPECT_EQ(samples[1], 0.1F);
    EXPECT_EQ(samples[2], 0.0F);
    EXPECT_EQ(samples[3], 0.0F);
    EXPECT_GT(samples[4], 0.99F);
    EXPECT_LT(samples[5], -0.7F);
    EXPECT_EQ(limiter.nonFiniteCount(), 3U);
    EXPECT_EQ(limiter.limitedCount(), 2U);
    limit(limiter, std::span(samples).first(1));
    EXPECT_EQ(limiter.nonFiniteCount(), 3U);
}

TEST(LimiterTest, AFullScaleThatIsNotPositiveIsRejected) {
    for (const float fullScale : {0.0F, -60.0F, notANumber, infinity}) {
        EXPECT_THROW(SoftLimiter{fullScale}, std::invalid_argument) << fullScale;
    }
}

double gainDbAt(double frequencyHz) {
    HighPass filter;
    std::vector<float> wave = haptoflow::testing::sinusoid(8000, frequencyHz);
    const double before = haptoflow::testing::levelDecibels(std::span(wave).last(4000));
    filter.process(wave);
    return haptoflow::testing::levelDecibels(std::span(wave).last(4000)) - before;
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

// Volatile operands keep the compiler from evaluating the arithmetic at compile time.
float halfOfTheSmallestNormal() {
    volatile float smallest = std::numeric_limits<float>::min();
    volatile float half = 0.5F;
    return smallest * half;
}

float denormalTimesALot() {
    volatile float denormal = std::numeric_limits<float>::denorm_min();
    volatile float lot = 1e30F;
    return denormal * lot;
}

TEST(DenormalsTest, DenormalResultsAndOperandsAreFlushedOnlyWithinTheScope) {
    if (!ScopedFlushDenormals::isSupported) {
        GTEST_SKIP() << "this processor has no mode for it";
    }
    ASSERT_GT(halfOfTheSmallestNormal(), 0.0F);
    ASSERT_GT(denormalTimesALot(), 0.0F);
    {
        const ScopedFlushDenormals flush;
        EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F);
        EXPECT_EQ(denormalTimesALot(), 0.0F);
        {
            const ScopedFlushDenormals nested;
            EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F);
        }
        EXPECT_EQ(halfOfTheSmallestNormal(), 0.0F) << "leaving an inner scope ended the outer one";
    }
    EXPECT_GT(halfOfTheSmallestNormal(), 0.0F);
    EXPECT_GT(denormalTimesALot(), 0.0F);
}

}  // namespace
}  // namespace haptoflow::dsp
