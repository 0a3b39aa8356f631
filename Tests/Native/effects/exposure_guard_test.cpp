#include "effects/exposure_guard.hpp"

#include "support/counting_new.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr double voiceRateHz = 8000.0;

/// A law with a reference time of eight minutes instead of eight hours, to shorten the tests.
ExposureLaw shortDay() {
    ExposureLaw law;
    law.dailySeconds = 480.0;
    law.reserveSeconds = 10.0;
    return law;
}

struct Tone {
    double frequencyHz;
    double amplitudeMps2;
};

/// Plays tones through a guard block by block and records its gain and exposure.
class Session {
public:
    explicit Session(ExposureGuard& guard, double sampleRateHz = voiceRateHz) : guard_(guard), rateHz_(sampleRateHz) {}

    void play(double seconds, const std::vector<Tone>& tones) {
        const auto count = static_cast<std::uint64_t>(std::llround(seconds * rateHz_));
        std::vector<float> sent;
        std::vector<float> block;
        for (std::uint64_t done = 0; done < count; done += block.size()) {
            sent.assign(static_cast<std::size_t>(std::min<std::uint64_t>(400, count - done)), 0.0F);
            for (const Tone& tone : tones) {
                add(tone, sent);
            }
            at_ += sent.size();
            block = sent;
            guard_.process(block);
            untouched = untouched && block == sent;
            lastRmsMps2 = haptoflow::testing::rms(block);
            const double gain = guard_.report().gain;
            const double blockSeconds = static_cast<double>(block.size()) / rateHz_;
            steepestDbPerSecond =
                std::max(steepestDbPerSecond, std::abs(20.0 * std::log10(gain / lastGain_)) / blockSeconds);
            highestDailyMps2 = std::max(highestDailyMps2, guard_.report().dailyMps2);
            lastGain_ = gain;
        }
    }

    bool untouched = true;
    double lastRmsMps2 = 0.0;
    double steepestDbPerSecond = 0.0;
    double highestDailyMps2 = 0.0;

private:
    // A rotating phasor, because calling std::sin for a hundred million samples would dominate the test's time.
    void add(const Tone& tone, std::vector<float>& samples) const {
        const double turn = 2.0 * std::numbers::pi * tone.frequencyHz / rateHz_;
        const double start = std::fmod(tone.frequencyHz * static_cast<double>(at_) / rateHz_, 1.0);
        double sine = tone.amplitudeMps2 * std::sin(2.0 * std::numbers::pi * start);
        double cosine = tone.amplitudeMps2 * std::cos(2.0 * std::numbers::pi * start);
        const double sineTurn = std::sin(turn);
        const double cosineTurn = std::cos(turn);
        for (float& sample : samples) {
            sample += static_cast<float>(sine);
            const double next = sine * cosineTurn + cosine * sineTurn;
            cosine = cosine * cosineTurn - sine * sineTurn;
            sine = next;
        }
    }

    ExposureGuard& guard_;
    double rateHz_;
    std::uint64_t at_ = 0;
    double lastGain_ = 1.0;
};

// Tones with the unweighted and weighted levels of the shipped strokes on the loudest labels at 3 N.
const std::vector<Tone> wholeSet{{160.0, 43.6}, {25.0, 12.0}};  // 32 m/s^2, weighted 6.3
const std::vector<Tone> fullScale{{160.0, 200.0}};

TEST(ExposureGuardTest, AnHourOfSlidingOverTheLoudestLabelsIsNotReduced) {
    ExposureGuard guard(voiceRateHz);
    Session session(guard);
    session.play(3600.0, wholeSet);
    EXPECT_TRUE(session.untouched);
    EXPECT_EQ(guard.report().reason, ExposureReason::none);
    EXPECT_NEAR(guard.report().shortTermMps2, 32.0, 0.5);
    EXPECT_NEAR(guard.report().dailyMps2, 6.3 * std::sqrt(1.0 / 8.0), 0.1);
}

TEST(ExposureGuardTest, MinutesAtFullScaleAreReducedToTheShortTermLimitWithThatReason) {
    ExposureGuard guard(voiceRateHz);
    Session session(guard);
    session.play(55.0, fullScale);
    EXPECT_TRUE(session.untouched);
    session.play(20.0, fullScale);
    EXPECT_FALSE(session.untouched);
    EXPECT_EQ(guard.report().reason, ExposureReason::shortTerm);
    EXPECT_GT(guard.report().loweredSeconds, 5.0);
    session.play(200.0, fullScale);
    const double expected = 200.0 / std::numbers::sqrt2 * 60.0 / guard.report().shortTermMps2;
    EXPECT_NEAR(session.lastRmsMps2, expected, 0.02 * expected);
    session.play(1500.0, fullScale);
    EXPECT_LT(session.lastRmsMps2, 61.0);
    EXPECT_LE(session.steepestDbPerSecond, 1.21) << "a block of 50 ms may end within a hundredth of a second";
}

TEST(ExposureGuardTest, ALevelThatUsesUpTheDailyDoseIsReducedWithThatReason) {
    ExposureGuard guard(voiceRateHz);
    Session session(guard);
    // 20 m/s^2 at 16 Hz has an RMS of 14.1 m/s^2 unweighted, far below the first limit, and 12.7 m/s^2 weighted. Of the
    // daily dose of 180000 m^2/s^3, 84000 are used after 520 s; the rest would last for less than 600 s.
    session.play(500.0, {{16.0, 20.0}});
    EXPECT_TRUE(session.untouched);
    session.play(60.0, {{16.0, 20.0}});
    EXPECT_FALSE(session.untouched);
    EXPECT_EQ(guard.report().reason, ExposureReason::dose);
    EXPECT_LE(session.steepestDbPerSecond, 1.21);
}

TEST(ExposureGuardTest, TheGainMovesLinearlyWithinEachHundredthOfASecond) {
    ExposureLaw law;
    law.shortTermSeconds = 0.2;
    ExposureGuard guard(voiceRateHz, law);
    std::vector<float> samples(16000, 150.0F);
    guard.process(samples);
    const double perSample = std::pow(10.0, law.slewDbPerSecond / voiceRateHz / 20.0) - 1.0;
    for (std::size_t i = 1; i < samples.size(); ++i) {
        const double change = static_cast<double>(samples[i] / samples[i - 1]) - 1.0;
        ASSERT_LE(std::abs(change), 1.5 * perSample + 2e-7) << i;
    }
    EXPECT_LT(samples.back(), 140.0F);
}

TEST(ExposureGuardTest, TheDailyExposureApproachesItsLimitAndDoesNotPassIt) {
    ExposureGuard guard(voiceRateHz, shortDay());
    Session session(guard);
    session.play(1000.0, {{16.0, 20.0}});
    EXPECT_LE(session.highestDailyMps2, 2.5 * 1.1)
        << "the dose limit was exceeded by more than the sound while the gain moves";
    EXPECT_GT(session.highestDailyMps2, 2.4);
}

TEST(ExposureGuardTest, ExposureOlderThanEightHoursNoLongerCounts) {
    ExposureGuard guard(voiceRateHz, shortDay());
    Session session(guard);
    session.play(60.0, {{16.0, 20.0}});
    ASSERT_LT(guard.report().gain, 0.5);
    session.play(500.0, {});
    EXPECT_LT(guard.report().dailyMps2, 1e-3);
    session.play(60.0, {{16.0, 1.0}});
    EXPECT_EQ(guard.report().gain, 1.0);
    EXPECT_EQ(guard.report().reason, ExposureReason::none);
    EXPECT_EQ(guard.report().loweredSeconds, 0.0);
    session.untouched = true;
    session.play(10.0, {{16.0, 1.0}});
    EXPECT_TRUE(session.untouched);
}

TEST(ExposureGuardTest, TheGainRecoversAsSlowlyAsItFalls) {
    ExposureLaw law;
    law.shortTermSeconds = 2.0;
    law.dailyMps2 = 1000.0;
    ExposureGuard guard(voiceRateHz, law);
    Session session(guard);
    session.play(30.0, fullScale);
    ASSERT_NEAR(guard.report().gain, 60.0 / 141.4, 0.01);
    session.play(3.0, {});
    EXPECT_LT(guard.report().gain, 0.7);
    EXPECT_FALSE(guard.isIdle());
    session.play(10.0, {});
    EXPECT_EQ(guard.report().gain, 1.0);
    EXPECT_TRUE(guard.isIdle());
    EXPECT_LE(session.steepestDbPerSecond, 1.21);
}

TEST(ExposureGuardTest, TheGainNeverFallsBelowTheMinimum) {
    ExposureLaw law = shortDay();
    law.shortTermSeconds = 2.0;
    law.actuatorGain = 1000.0;
    ExposureGuard guard(voiceRateHz, law);
    Session session(guard);
    session.play(120.0, fullScale);
    EXPECT_NEAR(guard.report().gain, law.minimumGain, 1e-9);
    // After the actuator's gain is corrected, the gain returns from the minimum of -40 dB at 1 dB/s.
    guard.setActuatorGain(1.0);
    guard.passSilence(static_cast<std::uint64_t>(480.0 * voiceRateHz));
    guard.passSilence(static_cast<std::uint64_t>(46.0 * voiceRateHz));
    EXPECT_EQ(guard.report().gain, 1.0);
}

TEST(ExposureGuardTest, TheActuatorsGainScalesTheMeasuredExposure) {
    ExposureGuard weak(voiceRateHz);
    ExposureGuard strong(voiceRateHz);
    weak.setActuatorGain(0.25);
    strong.setActuatorGain(0.5);
    strong.setActuatorGain(std::numeric_limits<double>::quiet_NaN());
    strong.setActuatorGain(0.0);
    strong.setActuatorGain(-1.0);
    strong.setActuatorGain(std::numeric_limits<double>::infinity());
    Session first(weak);
    Session second(strong);
    first.play(10.0, fullScale);
    second.play(10.0, fullScale);
    EXPECT_NEAR(strong.report().shortTermMps2 / weak.report().shortTermMps2, 2.0, 1e-6);
    EXPECT_NEAR(strong.report().dailyMps2 / weak.report().dailyMps2, 2.0, 1e-6);
}

TEST(ExposureGuardTest, TheResultIsTheSameAtEveryRate) {
    ExposureLaw law = shortDay();
    law.shortTermSeconds = 4.0;
    const auto reportsAt = [&law](double rate) {
        ExposureGuard guard(rate, law);
        Session session(guard, rate);
        std::vector<ExposureReport> reports;
        for (int step = 0; step < 6; ++step) {
            session.play(2.0, {{20.0 + 30.0 * step, 40.0 * (step + 1)}});
            reports.push_back(guard.report());
        }
        return reports;
    };
    const std::vector<ExposureReport> expected = reportsAt(48000.0);
    for (const double rate : {8000.0, 11025.0, 44100.0, 192000.0}) {
        const std::vector<ExposureReport> reports = reportsAt(rate);
        for (std::size_t step = 0; step < reports.size(); ++step) {
            EXPECT_NEAR(reports[step].shortTermMps2 / expected[step].shortTermMps2, 1.0, 0.01) << rate;
            EXPECT_NEAR(reports[step].dailyMps2 / expected[step].dailyMps2, 1.0, 0.01) << rate;
            EXPECT_NEAR(20.0 * std::log10(reports[step].gain / expected[step].gain), 0.0, 0.1) << rate;
        }
        EXPECT_LT(reports.back().gain, 0.7);
    }
}

class ExposureDayTest : public ::testing::TestWithParam<double> {};

TEST_P(ExposureDayTest, InSilenceTheGainNeverFallsAndReturnsWithTheDose) {
    for (const double playSeconds : {1.0, 30.0}) {
        ExposureGuard guard(voiceRateHz);
        guard.setActuatorGain(GetParam());
        Session session(guard);
        session.play(playSeconds, wholeSet);
        double gain = guard.report().gain;
        const double played = gain;
        const double usedShare = std::pow(guard.report().dailyMps2 / 2.5, 2.0);
        for (int minute = 1; minute <= 9 * 60; ++minute) {
            for (int block = 0; block < 60; ++block) {
                guard.passSilence(static_cast<std::uint64_t>(voiceRateHz));
                ASSERT_GE(guard.report().gain, gain) << "after " << minute << " minutes";
                gain = guard.report().gain;
            }
            if (minute == 60 && played < 1.0) {
                const double left = std::sqrt(std::max(0.0, 1.0 - usedShare));
                EXPECT_GE(gain, std::min(1.0, 0.99 * std::max(left, 0.01))) << "an hour's silence leaves the dose only";
            }
        }
        EXPECT_EQ(gain, 1.0) << "after nine hours; " << playSeconds << " s played";
        EXPECT_EQ(guard.report().reason, ExposureReason::none);
        EXPECT_EQ(guard.report().loweredSeconds, 0.0);
    }
}

INSTANTIATE_TEST_SUITE_P(AtActuatorGain, ExposureDayTest, ::testing::Values(1.0, 20.0));

TEST(ExposureGuardTest, SwitchedOffItPassesTheSignalAndMeasuresOn) {
    ExposureGuard guard(voiceRateHz, shortDay());
    Session session(guard);
    session.play(60.0, {{16.0, 20.0}});
    const double gain = guard.report().gain;
    const double daily = guard.report().dailyMps2;
    ASSERT_LT(gain, 0.5);
    guard.switchOn(false);
    session.play(0.05, {{16.0, 20.0}});
    session.untouched = true;
    session.play(10.0, {{16.0, 20.0}});
    EXPECT_TRUE(session.untouched);
    EXPECT_GT(guard.report().dailyMps2, 1.1 * daily);
    guard.switchOn(true);
    session.play(0.05, {{16.0, 20.0}});
    EXPECT_LE(guard.report().gain, gain);
    EXPECT_EQ(guard.report().reason, ExposureReason::dose);
}

TEST(ExposureGuardTest, AResetKeepsTheExposure) {
    ExposureGuard guard(voiceRateHz, shortDay());
    Session session(guard);
    session.play(60.0, {{16.0, 20.0}});
    const ExposureReport before = guard.report();
    ASSERT_LT(before.gain, 1.0);
    guard.reset();
    EXPECT_EQ(guard.report().gain, before.gain);
    EXPECT_EQ(guard.report().dailyMps2, before.dailyMps2);
}

TEST(ExposureGuardTest, NonFiniteSamplesBecomeZeroAndDoNotCount) {
    ExposureGuard guard(voiceRateHz);
    std::vector<float> samples(8000, 1.0F);
    samples[5] = std::numeric_limits<float>::quiet_NaN();
    samples[6] = std::numeric_limits<float>::infinity();
    samples[7] = -std::numeric_limits<float>::infinity();
    samples[8] = std::numeric_limits<float>::max();
    guard.process(samples);
    EXPECT_EQ(std::vector<float>(samples.begin() + 5, samples.begin() + 8), std::vector<float>(3, 0.0F));
    EXPECT_TRUE(std::isfinite(guard.report().dailyMps2));
    EXPECT_TRUE(std::isfinite(guard.report().shortTermMps2));
    EXPECT_GT(guard.report().gain, 0.0);
}

TEST(ExposureGuardTest, NothingAllocates) {
    ExposureGuard guard(48000.0, shortDay());
    std::vector<float> samples(512, 150.0F);
    const std::size_t before = haptoflow::testing::allocationCount();
    for (int block = 0; block < 500; ++block) {
        guard.setActuatorGain(1.0 + 0.001 * block);
        guard.process(samples);
        guard.passSilence(1000);
        static_cast<void>(guard.report());
    }
    guard.reset();
    EXPECT_EQ(haptoflow::testing::allocationCount(), before);
}

struct Factor {
    double frequencyHz;
    double weight;
};

// Factors of ISO 5349-1:2001, table A.2, as printed, at the exact centre frequencies of the one-third octaves.
constexpr Factor isoTable[] = {{6.31, 0.727},   {7.943, 0.873},  {10.0, 0.951},    {12.59, 0.958},   {15.85, 0.896},
                               {19.95, 0.782},  {25.12, 0.647},  {31.62, 0.519},   {39.81, 0.411},   {50.12, 0.324},
                               {63.1, 0.256},   {79.43, 0.202},  {100.0, 0.160},   {125.9, 0.127},   {158.5, 0.101},
                               {199.5, 0.0799}, {251.2, 0.0634}, {316.2, 0.0503},  {398.1, 0.0398},  {501.2, 0.0314},
                               {631.0, 0.0245}, {794.3, 0.0186}, {1000.0, 0.0135}, {1259.0, 0.00894}};

double measuredWeight(double frequencyHz, double sampleRateHz) {
    HandArmWeighting weighting(sampleRateHz);
    const double turn = 2.0 * std::numbers::pi * frequencyHz / sampleRateHz;
    const auto settle = static_cast<std::size_t>(sampleRateHz);
    const auto count = static_cast<std::size_t>(std::round(frequencyHz) * sampleRateHz / frequencyHz);
    double squares = 0.0;
    for (std::size_t i = 0; i < settle + count; ++i) {
        const double weighted = weighting.next(std::sin(turn * static_cast<double>(i)));
        squares += i < settle ? 0.0 : weighted * weighted;
    }
    return std::sqrt(2.0 * squares / static_cast<double>(count));
}

TEST(HandArmWeightingTest, TheWeightingMatchesTableA2OfIso5349AtEveryRate) {
    for (const double sampleRateHz : {8000.0, 24000.0, 44100.0, 48000.0, 192000.0}) {
        for (const Factor& factor : isoTable) {
            // The bilinear transform deviates near half the rate: at 8 kHz, by 2 % at 800 Hz and by 8 % at 1.26 kHz.
            const double tolerance = factor.frequencyHz * 13.0 > sampleRateHz ? 0.09 : 0.012;
            EXPECT_NEAR(measuredWeight(factor.frequencyHz, sampleRateHz) / factor.weight, 1.0, tolerance)
                << factor.frequencyHz << " Hz at " << sampleRateHz << " Hz";
        }
    }
}

TEST(HandArmWeightingTest, AConstantOffsetIsRemoved) {
    HandArmWeighting weighting(48000.0);
    double weighted = 1.0;
    for (int i = 0; i < 480000; ++i) {
        weighted = weighting.next(100.0);
    }
    EXPECT_NEAR(weighted, 0.0, 1e-6);
}

TEST(HandArmWeightingTest, AResetClearsTheState) {
    HandArmWeighting used(48000.0);
    HandArmWeighting fresh(48000.0);
    for (int i = 0; i < 1000; ++i) {
        static_cast<void>(used.next(i % 7));
    }
    used.reset();
    for (int i = 0; i < 100; ++i) {
        EXPECT_EQ(used.next(i % 5), fresh.next(i % 5));
    }
}

}  // namespace
}  // namespace haptoflow::effects
