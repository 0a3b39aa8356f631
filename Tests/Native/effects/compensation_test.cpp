#include "effects/compensation.hpp"

#include "effects/actuator_profile.hpp"
#include "effects/parallel_filter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::effects::compensation_test {
namespace {

constexpr double rateHz = 48000.0;
constexpr double twoPi = 2.0 * std::numbers::pi;
constexpr std::array rates{8000.0, 16000.0, 44100.0, 48000.0, 96000.0, 192000.0};

ActuatorProfile voiceCoil() {
    return *ActuatorProfile::builtIn("voice-coil");
}

ActuatorProfile profileOf(std::vector<double> frequencyHz, std::vector<double> magnitudeDecibels) {
    ActuatorProfile profile;
    profile.name = "test";
    profile.provenance = "test";
    profile.frequencyHz = std::move(frequencyHz);
    profile.magnitudeDecibels = std::move(magnitudeDecibels);
    return profile;
}

ActuatorProfile randomProfile(std::mt19937& random, double largestDecibels) {
    std::uniform_real_distribution<double> decibels(-largestDecibels, largestDecibels);
    std::uniform_real_distribution<double> octaves(0.01, 1.0);
    ActuatorProfile profile = profileOf({}, {});
    for (double hz = 15.0; hz < 2000.0; hz *= std::exp2(octaves(random))) {
        profile.frequencyHz.push_back(hz);
        profile.magnitudeDecibels.push_back(decibels(random));
    }
    profile.frequencyHz.push_back(2000.0);
    profile.magnitudeDecibels.push_back(0.0);
    return profile;
}

void run(Compensation& compensation, std::vector<float>& samples, std::size_t block = 256) {
    for (std::size_t i = 0; i < samples.size(); i += block) {
        compensation.process(std::span(samples).subspan(i, std::min(block, samples.size() - i)));
    }
}

/// The response measured with an impulse through `process`, over two seconds.
class MeasuredResponse {
public:
    // So large that the end of the impulse response lies far above the level that counts as silent.
    static constexpr double impulse = 1e5;

    MeasuredResponse(const ActuatorProfile& profile, double sampleRateHz, const CompensationSettings& settings = {})
        : rateHz_(sampleRateHz), samples_(static_cast<std::size_t>(2.0 * sampleRateHz)) {
        Compensation compensation(profile, sampleRateHz, settings);
        samples_[0] = static_cast<float>(impulse);
        run(compensation, samples_);
    }

    [[nodiscard]] double decibelsAt(double hz) const {
        std::complex<double> sum = 0.0;
        const std::complex<double> step = std::polar(1.0, -twoPi * hz / rateHz_);
        std::complex<double> turn = 1.0;
        for (const float sample : samples_) {
            sum += turn * static_cast<double>(sample);
            turn *= step;
        }
        return 20.0 * std::log10(std::abs(sum) / impulse);
    }

private:
    double rateHz_;
    std::vector<float> samples_;
};

std::vector<float> noise(std::size_t count, float amplitude, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(0.0F, amplitude);
    std::vector<float> samples(count);
    std::ranges::generate(samples, [&] { return normal(random); });
    return samples;
}

TEST(CompensationTest, TheCompensatedVoiceCoilIsFlatWithinThreeDecibelsFrom60To400HzAtEveryRate) {
    const ActuatorProfile coil = voiceCoil();
    for (const double rate : rates) {
        const MeasuredResponse response(coil, rate);
        const double level = Compensation(coil, rate).levelDecibels();
        double uncompensated = 0.0;
        for (double hz = 60.0; hz <= 400.0; hz *= std::exp2(1.0 / 24.0)) {
            const double played = coil.magnitudeDecibelsAt(hz) + response.decibelsAt(hz);
            EXPECT_NEAR(played, level, 3.0) << rate << " Hz, at " << hz << " Hz";
            uncompensated = std::max(uncompensated, std::abs(coil.magnitudeDecibelsAt(hz) - level));
        }
        EXPECT_GT(uncompensated, 6.0) << "the profile has nothing to compensate";
    }
}

TEST(CompensationTest, AnActuatorIsFlatWithinThreeDecibelsWhereTheBoostSuffices) {
    std::mt19937 random(5);
    for (int round = 0; round < 12; ++round) {
        const double low = std::uniform_real_distribution<double>(70.0, 200.0)(random);
        const double high = low * std::uniform_real_distribution<double>(1.6, 3.0)(random);
        const double depth = std::uniform_real_distribution<double>(-10.0, 0.0)(random);
        const ActuatorProfile profile =
            profileOf({20.0, 45.0, low, std::sqrt(low * high), high, 1200.0}, {-14.0, -9.0, 0.0, depth, -1.0, -8.0});
        const Compensation compensation(profile, rateHz);
        int flat = 0;
        for (double hz = 60.0; hz <= 400.0; hz *= std::exp2(1.0 / 24.0)) {
            const double wanted = compensation.levelDecibels() - profile.magnitudeDecibelsAt(hz);
            if (wanted < 9.0) {
                EXPECT_NEAR(compensation.gainDecibels(hz), wanted, 3.0) << round << ", at " << hz << " Hz";
                ++flat;
            }
        }
        EXPECT_GT(flat, 30) << round;
    }
}

TEST(CompensationTest, TheGainNeverExceedsTheMaximumBoostForAnyProfile) {
    std::mt19937 random(11);
    for (const double boost : {0.0, 3.0, 12.0, 24.0}) {
        for (int round = 0; round < 4; ++round) {
            const double extent = std::array{6.0, 20.0, 60.0, 200.0}[static_cast<std::size_t>(round) % 4];
            const Compensation compensation(randomProfile(random, extent), rateHz, {.maximumBoostDecibels = boost});
            for (double hz = 2.0; hz < 23000.0; hz *= 1.01) {
                ASSERT_LE(compensation.gainDecibels(hz), boost + 0.1) << boost << " dB, at " << hz << " Hz";
            }
        }
    }
    const Compensation coil(voiceCoil(), rateHz, {.maximumBoostDecibels = 3.0});
    EXPECT_GT(coil.gainDecibels(50.0), 1.0);
}

TEST(CompensationTest, FrequenciesWithoutActuatorOutputAreNotBoosted) {
    const ActuatorProfile silentBelow100Hz =
        profileOf({20.0, 60.0, 80.0, 100.0, 120.0, 300.0, 1200.0}, {-90.0, -90.0, -90.0, -10.0, 0.0, -3.0, -6.0});
    const Compensation compensation(silentBelow100Hz, rateHz);
    EXPECT_LT(compensation.gainDecibels(60.0), -6.0);
    EXPECT_GT(compensation.gainDecibels(100.0), 0.0);
}

TEST(CompensationTest, TheBandEndsWhereTheProfileEnds) {
    const Compensation compensation(profileOf({100.0, 150.0, 300.0}, {-6.0, 0.0, -6.0}), rateHz);
    EXPECT_EQ(compensation.bandHz()[0], 100.0);
    EXPECT_EQ(compensation.bandHz()[1], 300.0);
    EXPECT_NEAR(compensation.gainDecibels(50.0), 0.0, 0.7);
    EXPECT_NEAR(compensation.gainDecibels(600.0), 0.0, 0.7);
    EXPECT_TRUE(Compensation(profileOf({2000.0, 3000.0}, {0.0, -20.0}), rateHz).isTransparent());
    EXPECT_TRUE(Compensation(profileOf({1.0, 2.0}, {0.0, -20.0}), rateHz).isTransparent());
}

TEST(CompensationTest, TheFirstOutputSampleContainsTheFirstInputSample) {
    for (const double rate : rates) {
        Compensation compensation(voiceCoil(), rate);
        std::vector<float> samples(8);
        samples[0] = 1.0F;
        run(compensation, samples);
        EXPECT_GT(std::abs(samples[0]), 0.3F) << rate;
    }
}

TEST(CompensationTest, NoToneInTheBandExceedsTheDeclaredLatency) {
    std::mt19937 random(23);
    for (int round = 0; round < 5; ++round) {
        const ActuatorProfile profile = round == 0 ? voiceCoil() : randomProfile(random, 6.0);
        Compensation compensation(profile, rateHz);
        const double latency = compensation.latencySeconds();
        EXPECT_GE(latency, 0.0);
        for (double hz = 50.0; hz <= 900.0; hz *= 1.3) {
            // The energy centroid of a tone burst of 40 periods with a smooth window.
            const auto length = static_cast<std::size_t>(40.0 / hz * rateHz);
            std::vector<float> samples(2 * length);
            const auto centroid = [&samples] {
                double energy = 0.0;
                double moment = 0.0;
                for (std::size_t i = 0; i < samples.size(); ++i) {
                    const double power = static_cast<double>(samples[i]) * static_cast<double>(samples[i]);
                    energy += power;
                    moment += power * static_cast<double>(i) / rateHz;
                }
                return moment / energy;
            };
            for (std::size_t i = 0; i < length; ++i) {
                const double share = static_cast<double>(i) / static_cast<double>(length);
                samples[i] = static_cast<float>((0.5 - 0.5 * std::cos(twoPi * share)) *
                                                std::sin(twoPi * hz * static_cast<double>(i) / rateHz));
            }
            const double before = centroid();
            compensation.reset();
            run(compensation, samples);
            EXPECT_LE(centroid() - before, latency + 3e-4) << round << ", at " << hz << " Hz";
        }
    }
}

TEST(CompensationTest, TheOutputEndsWithinTheDeclaredTail) {
    for (const double rate : rates) {
        Compensation compensation(voiceCoil(), rate);
        EXPECT_TRUE(compensation.isIdle());
        std::vector<float> samples = noise(static_cast<std::size_t>(0.3 * rate), 60.0F, 4);
        std::ranges::for_each(samples, [](float& sample) { sample = std::clamp(sample, -200.0F, 200.0F); });
        run(compensation, samples);
        EXPECT_FALSE(compensation.isIdle());
        std::vector<float> silence(static_cast<std::size_t>(compensation.tailSeconds() * rate));
        run(compensation, silence);
        std::vector<float> more(256);
        run(compensation, more);
        EXPECT_TRUE(compensation.isIdle()) << rate;
        run(compensation, more);
        EXPECT_EQ(more, std::vector<float>(256, 0.0F)) << rate;
    }
}

TEST(CompensationTest, AFlatActuatorLeavesEverySampleUnchanged) {
    for (const double offset : {0.0, -30.0, 12.0}) {
        Compensation compensation(profileOf({20.0, 1200.0}, {offset, offset}), rateHz);
        EXPECT_TRUE(compensation.isTransparent()) << offset;
        const std::vector<float> before = noise(1000, 20.0F, 2);
        std::vector<float> after = before;
        run(compensation, after);
        EXPECT_EQ(after, before);
        EXPECT_TRUE(compensation.isIdle());
        EXPECT_EQ(compensation.latencySeconds(), 0.0);
        EXPECT_EQ(compensation.tailSeconds(), 0.0);
    }
    EXPECT_TRUE(Compensation(*ActuatorProfile::builtIn("flat"), 8000.0).isTransparent());
}

TEST(CompensationTest, NonFiniteAndHugeSamplesHaveNoLastingEffect) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float infinity = std::numeric_limits<float>::infinity();
    for (const double rate : rates) {
        Compensation compensation(voiceCoil(), rate);
        std::vector<float> samples = noise(static_cast<std::size_t>(0.1 * rate), 5.0F, 6);
        for (std::size_t i = 0; i < samples.size(); i += 7) {
            samples[i] = std::array{nan, infinity, -infinity, std::numeric_limits<float>::max()}[i % 4];
        }
        run(compensation, samples, 33);
        for (const float sample : samples) {
            ASSERT_TRUE(std::isfinite(sample));
            ASSERT_LT(std::abs(sample), 1e8F);
        }
        std::vector<float> silence(static_cast<std::size_t>(4.0 * rate));
        run(compensation, silence);
        EXPECT_TRUE(compensation.isIdle()) << rate;
    }
}

TEST(CompensationTest, SettingsOutOfRangeAreRejected) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double boost : {-1.0, 24.1, nan}) {
        EXPECT_THROW(Compensation(voiceCoil(), rateHz, {.maximumBoostDecibels = boost}), std::invalid_argument);
    }
    for (const std::array<double, 2> band :
         {std::array{19.0, 500.0}, {40.0, 1001.0}, {400.0, 60.0}, {nan, 400.0}, {60.0, nan}, {60.0, 60.0}}) {
        EXPECT_THROW(Compensation(voiceCoil(), rateHz, {.bandHz = band}), std::invalid_argument);
    }
}

}  // namespace
}  // namespace haptoflow::effects::compensation_test

namespace haptoflow::effects::minimum_phase_test {
namespace {

TEST(MinimumPhaseTest, ThePhaseOfAResonanceFollowsFromItsMagnitude) {
    constexpr double perOctave = 24.0;
    std::vector<double> magnitude;
    std::vector<double> phase;
    for (int point = 0; point < 400; ++point) {
        const double hz = 1.0 * std::exp2(point / perOctave);
        const std::complex<double> s(0.0, hz / 160.0);
        // A boost of 12 dB at 160 Hz, flat far from it.
        const std::complex<double> response = (s * s + s * 0.8 + 1.0) / (s * s + s * 0.2 + 1.0);
        magnitude.push_back(std::log(std::abs(response)));
        phase.push_back(std::arg(response));
    }
    const std::vector<double> found = minimumPhaseRadians(magnitude, 1.0 / perOctave);
    for (std::size_t point = 0; point < phase.size(); ++point) {
        EXPECT_NEAR(found[point], phase[point], 0.02) << point;
    }
}

TEST(MinimumPhaseTest, AConstantMagnitudeHasNoPhase) {
    for (const double phase : minimumPhaseRadians(std::vector<double>(50, 3.0), 0.1)) {
        EXPECT_EQ(phase, 0.0);
    }
}

}  // namespace
}  // namespace haptoflow::effects::minimum_phase_test

namespace haptoflow::effects::actuator_profile_test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string valid =
    R"({"format_version": 1, "name": "coil", "provenance": "a bench", "frequency_hz": [50, 100, 200],)"
    R"( "magnitude_db": [-10, 0, -3]})";

std::string with(const std::string& from, const std::string& to) {
    std::string text = valid;
    text.replace(text.find(from), from.size(), to);
    return text;
}

std::string refusalOf(const std::string& text) {
    try {
        (void)ActuatorProfile::parse(text);
    } catch (const ProfileError& error) {
        return error.what();
    }
    return "not refused";
}

TEST(ActuatorProfileTest, EveryFieldIsReadAndWrittenAgain) {
    const ActuatorProfile profile = ActuatorProfile::parse(
        R"({"format_version": 1, "name": "coil", "provenance": "a bench", "approximate": true, "rated_level_mps2": 40,
            "frequency_hz": [50, 100, 200], "magnitude_db": [-10, 0, -3], "phase_degrees": [90, 0, -90],
            "resonances_hz": [100], "measurement": {"sample_rate_hz": 48000, "delay_seconds": 0.25,
            "distortion_percent": 1.5, "signal_to_noise_db": 60}})");
    for (const ActuatorProfile& each : {profile, ActuatorProfile::parse(profile.toJson())}) {
        EXPECT_EQ(each.name, "coil");
        EXPECT_EQ(each.provenance, "a bench");
        EXPECT_TRUE(each.isApproximate);
        EXPECT_EQ(each.ratedLevelMps2, 40.0);
        EXPECT_THAT(each.frequencyHz, ElementsAre(50.0, 100.0, 200.0));
        EXPECT_THAT(each.magnitudeDecibels, ElementsAre(-10.0, 0.0, -3.0));
        EXPECT_THAT(each.phaseDegrees, ElementsAre(90.0, 0.0, -90.0));
        EXPECT_THAT(each.resonancesHz, ElementsAre(100.0));
        ASSERT_TRUE(each.measurement.has_value());
        EXPECT_EQ(each.measurement->delaySeconds, 0.25);
        EXPECT_EQ(each.measurement->signalToNoiseDecibels, 60.0);
    }
}

TEST(ActuatorProfileTest, OptionalKeysMayBeMissing) {
    const ActuatorProfile profile = ActuatorProfile::parse(valid);
    EXPECT_FALSE(profile.isApproximate);
    EXPECT_FALSE(profile.ratedLevelMps2.has_value());
    EXPECT_TRUE(profile.phaseDegrees.empty());
    EXPECT_FALSE(profile.measurement.has_value());
    EXPECT_EQ(ActuatorProfile::parse(profile.toJson()).toJson(), profile.toJson());
}

TEST(ActuatorProfileTest, TheMagnitudeIsInterpolatedOverTheLogarithmOfFrequency) {
    const ActuatorProfile profile = ActuatorProfile::parse(valid);
    EXPECT_NEAR(profile.magnitudeDecibelsAt(std::sqrt(50.0 * 100.0)), -5.0, 1e-12);
    EXPECT_NEAR(profile.magnitudeDecibelsAt(200.0 / std::exp2(1.0 / 3.0)), -2.0, 1e-12);
    EXPECT_EQ(profile.magnitudeDecibelsAt(100.0), 0.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(1.0), -10.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(5000.0), -3.0);
    EXPECT_EQ(profile.magnitudeDecibelsAt(std::nan("")), -10.0);
}

TEST(ActuatorProfileTest, AnErrorNamesTheKeyAndTheExpectedValue) {
    EXPECT_THAT(refusalOf(with("-3]", "-300]")),
                AllOf(HasSubstr("key \"magnitude_db[2]\""), HasSubstr("from -200 to 200, found -300")));
    EXPECT_THAT(refusalOf(with("-3]", "\"loud\"]")), HasSubstr("found \"loud\""));
    EXPECT_THAT(refusalOf(with("-3]", "null]")), HasSubstr("key \"magnitude_db[2]\""));
    EXPECT_THAT(refusalOf(with("-10, 0, -3", "-10, 0")),
                AllOf(HasSubstr("key \"magnitude_db\""), HasSubstr("an array of 3 numbers, found an array of 2")));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50, 200, 100")),
                HasSubstr("key \"frequency_hz[2]\": expected a number above the one before"));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50, 50, 100")), HasSubstr("key \"frequency_hz[1]\""));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "0, 50, 100")), HasSubstr("key \"frequency_hz[0]\""));
    EXPECT_THAT(refusalOf(with("50, 100, 200", "50")), HasSubstr("at least 2 elements"));
    EXPECT_THAT(refusalOf(with("\"format_version\": 1", "\"format_version\": 2")), HasSubstr("update HaptoFlow"));
    EXPECT_THAT(refusalOf(with("\"name\": \"coil\", ", "")), HasSubstr("expected a member \"name\""));
    EXPECT_THAT(refusalOf(with("coil", "")), HasSubstr("key \"name\""));
    EXPECT_THAT(refusalOf(with("coil", "a\\nb")), HasSubstr("text without control characters"));
    EXPECT_THAT(refusalOf(with("\"name\"", "\"nam\"")), HasSubstr("expected no key \"nam\"; known are format_version"));
    EXPECT_THAT(refusalOf(with("}", ", \"phase_degrees\": [1]}")), HasSubstr("key \"phase_degrees\""));
    EXPECT_THAT(refusalOf(with("}", ", \"rated_level_mps2\": 0}")), HasSubstr("key \"rated_level_mps2\""));
    EXPECT_THAT(refusalOf(with("}", ", \"approximate\": 1}")), HasSubstr("true or false, found 1"));
    EXPECT_THAT(refusalOf(with("}", ", \"measurement\": {}}")), HasSubstr("expected a member \"sample_rate_hz\""));
}

TEST(ActuatorProfileTest, InvalidTextIsRejectedWithAOneLineMessage) {
    std::string manyPoints = R"({"format_version": 1, "name": "n", "provenance": "p", "frequency_hz": [1)";
    for (int point = 2; point < 6000; ++point) {
        manyPoints += "," + std::to_string(point);
    }
    const std::string deep(100000, '[');
    std::vector<std::string> texts{"",
                                   "null",
                                   "[]",
                                   "{",
                                   "NaN",
                                   deep,
                                   std::string(ActuatorProfile::maximumTextBytes + 1, ' '),
                                   manyPoints + "]}",
                                   with("-3", "NaN"),
                                   with("-3", "Infinity"),
                                   with("-3", "1e999"),
                                   with("-3", "1e308"),
                                   with("coil", "\xff\xfe"),
                                   with("coil", std::string(200, 'x')),
                                   with("\"name\"", "\"name\": \"one\", \"name\""),
                                   with("\"coil\"", "{\"a\": 1}"),
                                   with("[50, 100, 200]", "[[50], 100, 200]")};
    for (const std::string& text : texts) {
        const std::string refusal = refusalOf(text);
        EXPECT_NE(refusal, "not refused") << text.substr(0, 80);
        EXPECT_EQ(refusal.find('\n'), std::string::npos) << refusal;
        EXPECT_LT(refusal.size(), 400U) << refusal;
    }
}

TEST(ActuatorProfileTest, AProfileWithAChangedByteIsRejectedOrUsable) {
    std::mt19937 random(7);
    for (int round = 0; round < 4000; ++round) {
        std::string text = valid;
        for (unsigned change = 0; change <= random() % 3; ++change) {
            text[random() % text.size()] = static_cast<char>(random() % 256);
        }
        try {
            const ActuatorProfile profile = ActuatorProfile::parse(text);
            ASSERT_EQ(profile.frequencyHz.size(), profile.magnitudeDecibels.size()) << text;
            for (double hz = 1.0; hz < 1e4; hz *= 1.3) {
                ASSERT_TRUE(std::isfinite(profile.magnitudeDecibelsAt(hz))) << text;
            }
        } catch (const ProfileError&) {
        }
    }
}

TEST(ActuatorProfileTest, TheBuiltInProfilesAreFlatAndThePapersApproximateVoiceCoil) {
    for (const std::string_view name : {"flat", "voice-coil"}) {
        const auto profile = ActuatorProfile::builtIn(name);
        ASSERT_TRUE(profile.has_value()) << name;
        EXPECT_EQ(profile->name, name);
    }
    EXPECT_FALSE(ActuatorProfile::builtIn("voice coil").has_value());
    const ActuatorProfile flat = *ActuatorProfile::builtIn("flat");
    for (const double hz : {10.0, 50.0, 160.0, 1000.0, 5000.0}) {
        EXPECT_EQ(flat.magnitudeDecibelsAt(hz), 0.0);
    }
    const ActuatorProfile coil = *ActuatorProfile::builtIn("voice-coil");
    EXPECT_TRUE(coil.isApproximate);
    EXPECT_THAT(coil.resonancesHz, ElementsAre(160.0, 320.0));
    for (const double hz : {160.0, 320.0}) {
        for (const double factor : {0.8, 1.25}) {
            EXPECT_GT(coil.magnitudeDecibelsAt(hz), coil.magnitudeDecibelsAt(hz * factor) + 2.0) << hz * factor;
        }
    }
    for (double hz = 50.0; hz <= 100.0; hz *= 1.05) {
        EXPECT_LT(coil.magnitudeDecibelsAt(hz), -7.0) << hz;
    }
}

}  // namespace
}  // namespace haptoflow::effects::actuator_profile_test
