#include "engine/voice.hpp"

#include "engine/seam_statistics.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace haptoflow::engine {
namespace {

EffectFigures unreadFigures;
constexpr double playedRateHz = 48000.0;

/// 0.2 s of a tone of 120 Hz at a level in m/s^2, as corrections of a stream of zeros, from the head on.
void takeTone(Voice& voice, float levelMps2) {
    const std::int64_t head = voice.waveform().head();
    for (std::int64_t part = 0; part < 2; ++part) {
        Correction correction{.start = head + part * static_cast<std::int64_t>(inference::segmentSamples)};
        for (std::size_t i = 0; i < correction.unit.size(); ++i) {
            const double t = static_cast<double>(correction.start - head + static_cast<std::int64_t>(i)) / 2000.0;
            correction.unit[i] =
                levelMps2 * static_cast<float>(std::numbers::sqrt2 * std::sin(2.0 * std::numbers::pi * 120.0 * t));
        }
        ASSERT_GE(voice.take(correction), 0);
    }
}

/// A touch on a model without a skeleton, at a level of 1 m/s^2.
void begin(Voice& voice) {
    skeleton::StreamParameters parameters;
    parameters.levelMps2 = 1.0F;
    voice.begin(parameters, 0.0, {}, std::array<float, inference::segmentSamples>{});
}

void beginTone(Voice& voice, float levelMps2) {
    begin(voice);
    takeTone(voice, levelMps2);
}

std::vector<float> renderSamples(Voice& voice, std::size_t count) {
    std::vector<float> samples(count);
    voice.render(samples);
    return samples;
}

TEST(VoiceTest, WithoutTouchTheVoiceWritesZerosAndItsClockStandsStill) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    const std::int64_t head = voice.waveform().head();
    const std::vector<float> output = renderSamples(voice, 4800);
    EXPECT_TRUE(std::ranges::all_of(output, [](float sample) { return sample == 0.0F; }));
    EXPECT_EQ(voice.waveform().head(), head);
    EXPECT_TRUE(voice.isSilent());
}

TEST(VoiceTest, ATouchDuringAFadeStartsWithoutAStep) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    beginTone(voice, 6.0F);
    std::vector<float> output = renderSamples(voice, 1777);
    const float ordinaryStep = testing::largestStep(output);
    for (int touch = 0; touch < 6; ++touch) {
        voice.release();
        const std::vector<float> fading = renderSamples(voice, 101);
        output.insert(output.end(), fading.begin(), fading.end());
        beginTone(voice, 6.0F);
        const std::vector<float> sounding = renderSamples(voice, 733);
        output.insert(output.end(), sounding.begin(), sounding.end());
    }
    // A seam in the waveform is a splice of 4 samples at 2 kHz, which is steeper than the tone but not a step.
    EXPECT_LE(testing::largestStep(output), 6.0F * ordinaryStep);
}

TEST(VoiceTest, TheOutputDoesNotDependOnTheBlockLength) {
    Voice whole(playedRateHz, 60.0F, unreadFigures);
    Voice pieces(playedRateHz, 60.0F, unreadFigures);
    beginTone(whole, 3.0F);
    beginTone(pieces, 3.0F);
    const std::vector<float> expected = renderSamples(whole, 4096);
    std::vector<float> output;
    for (const std::size_t count : {1U, 63U, 64U, 65U, 256U, 700U, 1000U, 1947U}) {
        const std::vector<float> block = renderSamples(pieces, count);
        output.insert(output.end(), block.begin(), block.end());
    }
    ASSERT_EQ(output.size(), expected.size());
    EXPECT_TRUE(std::equal(output.begin(), output.end(), expected.begin()));
}

TEST(VoiceTest, ANonFiniteCorrectionGivesSilenceAndIsCounted) {
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    beginTone(voice, 6.0F);
    Correction broken{.start = voice.waveform().head() + 10};
    broken.unit[100] = std::nanf("");
    ASSERT_GE(voice.take(broken), 0);
    const std::vector<float> output = renderSamples(voice, 9600);
    EXPECT_TRUE(std::ranges::all_of(output, [](float sample) { return std::isfinite(sample); }));
    EXPECT_GT(voice.limiter().nonFiniteCount(), 0U);
    voice.release();
    (void)renderSamples(voice, 480);
    beginTone(voice, 6.0F);
    EXPECT_GT(testing::peak(renderSamples(voice, 960)), 0.1F) << "the next touch must sound normally";
}

TEST(VoiceTest, InsideTheRangeTheFiltersDelayByAtMostOneAndAHalfMilliseconds) {
    // A step in the waveform at a known sample. The delay is the time until half of the step has been output.
    Voice voice(playedRateHz, 60.0F, unreadFigures);
    begin(voice);
    std::vector<float> output = renderSamples(voice, 480);
    const std::int64_t step = voice.waveform().head() + 10;
    Correction correction{.start = step - 10};
    std::fill(correction.unit.begin() + 10, correction.unit.end(), 6.0F);
    ASSERT_EQ(voice.take(correction), step - 10);
    const double readAt = 480.0 / playedRateHz + 10.0 / 2000.0;
    const std::vector<float> later = renderSamples(voice, 2400);
    output.insert(output.end(), later.begin(), later.end());
    const auto half = std::ranges::find_if(output, [](float sample) { return sample >= 0.05F; });
    const double seconds = static_cast<double>(half - output.begin()) / playedRateHz;
    EXPECT_GE(seconds, readAt - 0.0005) << "the step cannot be output before it was read";
    EXPECT_LE(seconds - readAt, 0.0015);
}

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
        meter.addSeam(seam);
    }
    meter.addSamples(waveform);
    return meter.statistics();
}

TEST(SeamStatisticsTest, SeamsInAConstantSlopeAreNotOutliersAndWithoutAWaveOrSeamsTheStatisticsAreZero) {
    const SeamStatistics sloping = measureSeams(ramp(1000), std::vector<std::int64_t>{100, 200, 300}, 4);
    EXPECT_EQ(sloping.seams, 3U);
    EXPECT_NEAR(sloping.jumpRatio, 1.0, 1e-3);
    const SeamStatistics none = measureSeams({}, {}, 4);
    EXPECT_EQ(none.seams, 0U);
    EXPECT_EQ(none.jumpRatio, 0.0);
    EXPECT_EQ(measureSeams(ramp(10), {}, 4).outlierShare, 0.0);
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

}  // namespace
}  // namespace haptoflow::engine
