#include "effects/wave_features.hpp"

#include "open_engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

/// A sine of 150 Hz whose amplitude swells twice per second.
std::vector<float> swellingTone(double rateHz, double seconds) {
    std::vector<float> wave(static_cast<std::size_t>(rateHz * seconds));
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double time = static_cast<double>(i) / rateHz;
        const double envelope = 3.0 + 2.0 * std::sin(2.0 * std::numbers::pi * 2.0 * time);
        wave[i] = static_cast<float>(envelope * std::sin(2.0 * std::numbers::pi * 150.0 * time));
    }
    return wave;
}

class WaveFeaturesApiTest : public ::testing::Test {
protected:
    void TearDown() override { EXPECT_EQ(haptoflow_wave_features_close(&features_), HAPTOFLOW_OK); }

    static haptoflow_wave_features_options options(uint32_t sampleRateHz = 0, double frameSeconds = 0.0) {
        return {sizeof(haptoflow_wave_features_options), sampleRateHz, frameSeconds, 0.0, 0.0};
    }

    void create(const haptoflow_wave_features_options& options) {
        ASSERT_EQ(haptoflow_wave_features_create(&options, &features_), HAPTOFLOW_OK) << message();
    }

    std::vector<haptoflow_wave_frame> process(const std::vector<float>& wave, std::size_t block, uint64_t room = 32) {
        std::vector<haptoflow_wave_frame> all;
        std::vector<haptoflow_wave_frame> taken(room);
        for (std::size_t i = 0; i < wave.size(); i += block) {
            uint64_t count = 0;
            EXPECT_EQ(haptoflow_wave_features_process(features_, wave.data() + i, std::min(block, wave.size() - i),
                                                      taken.data(), taken.size(), &count),
                      HAPTOFLOW_OK)
                << message();
            all.insert(all.end(), taken.begin(), taken.begin() + static_cast<std::ptrdiff_t>(count));
        }
        return all;
    }

    haptoflow_wave_features* features_ = nullptr;
};

TEST_F(WaveFeaturesApiTest, FramesEqualThoseOfTheEffectsLibrary) {
    const std::vector<float> wave = swellingTone(2000.0, 1.0);
    create(options(0, 0.005));
    const auto taken = process(wave, 37);
    effects::WaveFeatures own;
    std::vector<effects::WaveFrame> expected(own.framesWithin(wave.size()));
    expected.resize(own.process(wave, expected).frames);
    ASSERT_EQ(taken.size(), expected.size());
    ASSERT_GE(taken.size(), 195U);
    for (std::size_t i = 0; i < taken.size(); ++i) {
        EXPECT_EQ(taken[i].first_sample, expected[i].firstSample);
        EXPECT_EQ(taken[i].sample_count, expected[i].sampleCount);
        EXPECT_EQ(taken[i].intensity, expected[i].intensity);
        EXPECT_EQ(taken[i].frequency_hz, expected[i].frequencyHz);
        EXPECT_EQ(taken[i].amplitude_mps2, expected[i].amplitudeMps2);
        EXPECT_EQ(taken[i].transient_amplitude_mps2, expected[i].transient.amplitudeMps2);
    }
}

TEST_F(WaveFeaturesApiTest, ADeviceWithOneFrequencyGetsItFromTheNextFrameOn) {
    create(options());
    (void)process(swellingTone(2000.0, 0.2), 400);
    ASSERT_EQ(haptoflow_wave_features_set_range(features_, 216.0, 216.0), HAPTOFLOW_OK);
    for (const haptoflow_wave_frame& frame : process(swellingTone(2000.0, 0.2), 400, 100)) {
        EXPECT_EQ(frame.frequency_hz, 216.0F);
    }
}

TEST_F(WaveFeaturesApiTest, OptionsOutOfRangeAreRefusedByName) {
    for (const uint32_t rate : {1999U, 3000U, 44100U, 194000U}) {
        const auto wrong = options(rate);
        EXPECT_EQ(haptoflow_wave_features_create(&wrong, &features_), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("sample_rate_hz"));
    }
    const auto shortFrames = options(0, 0.001);
    EXPECT_EQ(haptoflow_wave_features_create(&shortFrames, &features_), HAPTOFLOW_INVALID_ARGUMENT);
    auto range = options();
    range.minimum_frequency_hz = 300.0;
    range.maximum_frequency_hz = 200.0;
    EXPECT_EQ(haptoflow_wave_features_create(&range, &features_), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(features_, nullptr);
    create(options());
    EXPECT_EQ(haptoflow_wave_features_set_range(features_, 0.0, 100.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_wave_features_set_range(features_, std::numeric_limits<double>::quiet_NaN(), 100.0),
              HAPTOFLOW_INVALID_ARGUMENT);
    uint64_t count = 0;
    EXPECT_EQ(haptoflow_wave_features_process(features_, nullptr, 1, nullptr, 0, &count), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(DeviceLoudnessApiTest, AKindOrRateOrFullScaleOutOfRangeIsRefusedByName) {
    float share = 0.0F;
    for (const haptoflow_device_kind kind : {-1, 3, INT32_MAX}) {
        EXPECT_EQ(haptoflow_device_share(kind, 1.0F, &share), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_THAT(message(), ::testing::HasSubstr("expected 0 to 2"));
    }
    haptoflow_device_wave* wave = nullptr;
    EXPECT_EQ(haptoflow_device_wave_create(1000.0, &wave), HAPTOFLOW_INVALID_ARGUMENT);
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, &wave), HAPTOFLOW_OK) << message();
    float sample = 0.5F;
    for (const float scale : {0.0F, -1.0F, INFINITY, std::nanf("")}) {
        EXPECT_EQ(haptoflow_device_wave_process(wave, &sample, 1, scale), HAPTOFLOW_INVALID_ARGUMENT);
        EXPECT_EQ(sample, 0.5F);
    }
    EXPECT_EQ(haptoflow_device_wave_close(&wave), HAPTOFLOW_OK);
    EXPECT_EQ(wave, nullptr);
}

TEST(DeviceLoudnessApiTest, TheFullScaleOfTheWaveDoesNotChangeWhatIsPlayed) {
    std::vector<float> whole = swellingTone(8000.0, 0.5);
    std::vector<float> scaled = whole;
    std::ranges::for_each(scaled, [](float& sample) { sample /= 200.0F; });
    haptoflow_device_wave* wave = nullptr;
    ASSERT_EQ(haptoflow_device_wave_create(8000.0, &wave), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_device_wave_process(wave, whole.data(), whole.size(), 1.0F), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_reset(wave), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_process(wave, scaled.data(), scaled.size(), 200.0F), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_device_wave_close(&wave), HAPTOFLOW_OK);
    for (std::size_t i = 0; i < whole.size(); ++i) {
        ASSERT_NEAR(whole[i], scaled[i], 1e-5F) << i;
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
