// Learning through the C interface: a material's text, progress, cancellation, unusable recordings.
#include "inference/gaussian_noise.hpp"
#include "learning_options.hpp"
#include "open_engine.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using learning::testing::MadeRecording;

class LearningApiTest : public WithTinyModel {
protected:
    void TearDown() override {
        EXPECT_EQ(haptoflow_learning_close(&learning_), HAPTOFLOW_OK);
        EXPECT_EQ(learning_, nullptr);
        WithTinyModel::TearDown();
    }

    [[nodiscard]] haptoflow_learning_options options() const { return optionsOf(made_, runtime_, model_); }

    [[nodiscard]] std::string materialText() const {
        const char* json = nullptr;
        EXPECT_EQ(haptoflow_learning_material(learning_, &json), HAPTOFLOW_OK) << message();
        return json != nullptr ? json : "";
    }

    MadeRecording made_{{}, {}};
    haptoflow_learning* learning_ = nullptr;
};

TEST_F(LearningApiTest, ALearntMaterialIsRegisteredBesideTheModelsLabels) {
    auto given = options();
    given.category = "wood";
    given.licence = "CC BY 4.0";
    ASSERT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_OK) << message();
    const std::string text = materialText();
    const nlohmann::json json = nlohmann::json::parse(text);
    EXPECT_EQ(json["name"], "made surface");
    EXPECT_EQ(json["category"], "wood");
    EXPECT_EQ(json["provenance"]["licence"], "CC BY 4.0");
    const char* space = nullptr;
    ASSERT_EQ(haptoflow_model_space(model_, &space), HAPTOFLOW_OK);
    EXPECT_EQ(json["space"], space);

    haptoflow_engine_options engineOptions{};
    engineOptions.struct_size = sizeof(engineOptions);
    engineOptions.runtime = runtime_;
    engineOptions.model = model_;
    engineOptions.without_worker = 1;
    engineOptions.quality = HAPTOFLOW_QUALITY_DRAFT;
    haptoflow_engine* engine = nullptr;
    ASSERT_EQ(haptoflow_engine_create(&engineOptions, &engine), HAPTOFLOW_OK) << message();
    uint32_t index = 0;
    EXPECT_EQ(haptoflow_engine_register_material(engine, text.data(), text.size(), &index), HAPTOFLOW_OK) << message();
    uint32_t labels = 0;
    EXPECT_EQ(haptoflow_model_label_count(model_, &labels), HAPTOFLOW_OK);
    EXPECT_EQ(index, labels);
    EXPECT_EQ(haptoflow_engine_close(&engine), HAPTOFLOW_OK);

    const char* report = nullptr;
    ASSERT_EQ(haptoflow_learning_report(learning_, &report), HAPTOFLOW_OK) << message();
    const nlohmann::json figures = nlohmann::json::parse(report);
    EXPECT_TRUE(figures.contains("nearest_label"));
    EXPECT_TRUE(figures.contains("start_label"));
    uint32_t tiers = 0;
    EXPECT_EQ(haptoflow_model_tier_count(model_, &tiers), HAPTOFLOW_OK);
    EXPECT_EQ(figures.at("other_tiers").size(), tiers - 1U);
    EXPECT_GT(figures["segments"].get<int>(), 1000);
    EXPECT_FALSE(figures["stopped_early"].get<bool>());
}

TEST_F(LearningApiTest, EqualOptionsGiveEqualBytes) {
    const auto given = options();
    ASSERT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_OK) << message();
    const std::string first = materialText();
    ASSERT_EQ(haptoflow_learning_close(&learning_), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_OK) << message();
    EXPECT_EQ(materialText(), first);
}

TEST_F(LearningApiTest, ProgressRisesAndEndsAtOne) {
    std::vector<double> shares;
    auto given = options();
    given.progress = [](void* context, double share, const char* doing) {
        EXPECT_NE(doing, nullptr);
        static_cast<std::vector<double>*>(context)->push_back(share);
    };
    given.progress_context = &shares;
    ASSERT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_OK) << message();
    ASSERT_GT(shares.size(), 5U);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_DOUBLE_EQ(shares.back(), 1.0);
}

TEST_F(LearningApiTest, ACancellationEndsLearningAndLeavesTheOutputUnchanged) {
    haptoflow_cancellation* cancellation = nullptr;
    ASSERT_EQ(haptoflow_cancellation_create(&cancellation), HAPTOFLOW_OK);
    auto given = options();
    given.cancellation = cancellation;
    given.progress = [](void* context, double share, const char*) {
        if (share > 0.2) {
            EXPECT_EQ(haptoflow_cancellation_cancel(static_cast<haptoflow_cancellation*>(context)), HAPTOFLOW_OK);
        }
    };
    given.progress_context = cancellation;
    EXPECT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_CANCELLED);
    EXPECT_EQ(learning_, nullptr);
    EXPECT_EQ(haptoflow_cancellation_close(&cancellation), HAPTOFLOW_OK);
}

TEST_F(LearningApiTest, AnUnusableRecordingIsReported) {
    auto given = options();
    given.sample_count = 4000;
    EXPECT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_RECORDING_UNUSABLE);
    EXPECT_THAT(message(), ::testing::HasSubstr("lasts 1 s"));
    EXPECT_STREQ(haptoflow_status_name(HAPTOFLOW_RECORDING_UNUSABLE), "HAPTOFLOW_RECORDING_UNUSABLE");
}

TEST_F(LearningApiTest, ArgumentsOutOfRangeAreRefusedByName) {
    const auto expectRefused = [&](const haptoflow_learning_options& given, const std::string& named) {
        EXPECT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_INVALID_ARGUMENT) << named;
        EXPECT_THAT(message(), ::testing::HasSubstr(named));
    };
    auto given = options();
    given.axis_count = 2;
    expectRefused(given, "axis_count");
    given = options();
    given.acceleration_mps2 = nullptr;
    expectRefused(given, "acceleration_mps2");
    given = options();
    given.name = nullptr;
    expectRefused(given, "name");
    given = options();
    given.name = "Denim";
    expectRefused(given, "Denim");
    given = options();
    given.sample_rate_hz = 500.0;
    expectRefused(given, "500 Hz");
    given = options();
    given.seconds_limit = -1.0;
    expectRefused(given, "seconds_limit");
    given = options();
    given.tier = "none";
    expectRefused(given, "none");
    given = options();
    given.sample_count = ~uint64_t{0};
    expectRefused(given, "sample_count");
    const std::array<float, 4> wild{1000.0F, 0.0F, 0.0F, 0.0F};
    given = options();
    given.wave_vectors = wild.data();
    expectRefused(given, "wave_vectors");
    given = options();
    given.runtime = nullptr;
    EXPECT_EQ(haptoflow_learn_material(&given, &learning_), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_learn_material(nullptr, &learning_), HAPTOFLOW_INVALID_ARGUMENT);
    given = options();
    EXPECT_EQ(haptoflow_learn_material(&given, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    const char* json = nullptr;
    EXPECT_EQ(haptoflow_learning_material(nullptr, &json), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_learning_report(nullptr, &json), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_learning_close(nullptr), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(RecordingWaveTest, AToneOnOneOfThreeAxesKeepsItsWaveWithoutGravity) {
    constexpr double inputHz = 4000.0;
    constexpr double waveHz = 2000.0;
    constexpr std::size_t samples = 4000;
    const auto tone = [](double seconds) { return 3.0 * std::sin(2.0 * std::numbers::pi * 150.0 * seconds); };
    std::vector<float> recorded(3 * samples, 0.0F);
    for (std::size_t i = 0; i < samples; ++i) {
        recorded[3 * i + 1] = static_cast<float>(tone(static_cast<double>(i) / inputHz));
        recorded[3 * i + 2] = 9.81F;
    }
    std::vector<float> wave(2100, 1.0F);
    ASSERT_EQ(haptoflow_recording_wave(recorded.data(), samples, 3, inputHz, wave.data(), wave.size()), HAPTOFLOW_OK)
        << message();
    for (std::size_t i = 500; i < 1500; i += 7) {
        EXPECT_NEAR(wave[i], tone(static_cast<double>(i) / waveHz), 0.05) << i;
    }
    EXPECT_EQ(wave.back(), 0.0F) << "beyond the recording's end";
}

struct RecordedNoise {
    static constexpr std::size_t samples = 8000;
    std::vector<float> wave = std::vector<float>(samples);
    std::vector<float> velocity = std::vector<float>(2 * samples);
    std::vector<float> force = std::vector<float>(samples, 1.0F);
    haptoflow_noise_source source = HAPTOFLOW_NOISE_QUIET_PART;
    double noiseMps2 = 0.0;

    /// At rest in the first half, sliding in the second.
    explicit RecordedNoise(float slidingGain) {
        inference::fillStandardNormal({.seed = 5, .voice = 0, .segment = 0}, wave);
        for (std::size_t i = 0; i < samples; ++i) {
            const bool slides = i >= samples / 2;
            wave[i] *= slides ? 0.04F * slidingGain : 0.04F;
            velocity[2 * i] = slides ? 0.1F : 0.0F;
        }
    }

    haptoflow_status remove() {
        return haptoflow_recording_remove_noise(wave.data(), velocity.data(), force.data(), wave.size(), &source,
                                                &noiseMps2);
    }
};

TEST(RecordingNoiseTest, TheNoiseAtRestIsRemovedAndTold) {
    RecordedNoise recorded(10.0F);
    recorded.wave[1000] = std::numeric_limits<float>::quiet_NaN();
    ASSERT_EQ(recorded.remove(), HAPTOFLOW_OK) << message();
    EXPECT_EQ(recorded.source, HAPTOFLOW_NOISE_REST);
    EXPECT_NEAR(recorded.noiseMps2, 0.04, 0.003);
    EXPECT_TRUE(std::isnan(recorded.wave[1000])) << "the mark between two recordings stays";
    double squares = 0.0;
    for (std::size_t i = 2000; i < 3500; ++i) {
        squares += static_cast<double>(recorded.wave[i]) * recorded.wave[i] / 1500.0;
    }
    EXPECT_LT(std::sqrt(squares), 0.012);
}

TEST(RecordingNoiseTest, ARecordingOfNothingElseIsRefused) {
    RecordedNoise recorded(1.0F);
    EXPECT_EQ(recorded.remove(), HAPTOFLOW_RECORDING_UNUSABLE);
    EXPECT_THAT(message(), ::testing::HasSubstr("no stronger where the tip slides"));
}

TEST(RecordingWaveTest, AnotherNumberOfAxesAndUnknownRatesAreRefusedByName) {
    std::array<float, 8> numbers{};
    EXPECT_EQ(haptoflow_recording_wave(numbers.data(), 2, 2, 2000.0, numbers.data(), 8), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("2 axes"));
    EXPECT_EQ(haptoflow_recording_wave(numbers.data(), 2, 1, 999.0, numbers.data(), 8), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("rate is 999 Hz"));
    EXPECT_EQ(haptoflow_resample(numbers.data(), 2, 2000.0, numbers.data(), 8, 1e9), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("expected 1000 to 192000 Hz"));
}

}  // namespace
}  // namespace haptoflow::capi::testing
