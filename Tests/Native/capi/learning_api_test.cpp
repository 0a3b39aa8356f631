// Recordings and learning through the C interface: handles, defaults, progress, cancellation, refusals.
#include "learning_options.hpp"
#include "open_engine.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using learning::testing::MadeRecording;
using ::testing::HasSubstr;

class LearningApiTest : public WithTinyModel {
protected:
    [[nodiscard]] haptoflow_learning_options options() const { return learningOptions(recording_, runtime_, model_); }

    MadeRecording made_{{}, {}};
    RecordingHandle recording_{recordingOf(infoOf(made_))};
    Handle<haptoflow_learning, haptoflow_learning_close> learning_;
};

TEST_F(LearningApiTest, ALearntMaterialIsRegisteredBesideTheModelsLabelsAndProgressEndsAtOne) {
    std::vector<double> shares;
    auto given = options();
    given.category = "wood";
    given.licence = "CC BY 4.0";
    given.progress = [](void* context, double share, const char* doing) {
        EXPECT_NE(doing, nullptr);
        static_cast<std::vector<double>*>(context)->push_back(share);
    };
    given.progress_context = &shares;
    ASSERT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_OK) << message();
    ASSERT_GT(shares.size(), 5U);
    EXPECT_TRUE(std::ranges::is_sorted(shares));
    EXPECT_DOUBLE_EQ(shares.back(), 1.0);

    const char* text = nullptr;
    const char* report = nullptr;
    ASSERT_EQ(haptoflow_learning_results(learning_, &text, &report), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_learning_results(learning_, nullptr, &report), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_learning_results(learning_, &text, nullptr), HAPTOFLOW_INVALID_ARGUMENT);
    const nlohmann::json json = nlohmann::json::parse(text);
    EXPECT_EQ(json["name"], "made surface") << "the recording's own";
    EXPECT_EQ(json["category"], "wood");
    EXPECT_EQ(json["provenance"]["licence"], "CC BY 4.0");
    const char* space = nullptr;
    ASSERT_EQ(haptoflow_model_space(model_, &space), HAPTOFLOW_OK);
    EXPECT_EQ(json["space"], space);
    const nlohmann::json figures = nlohmann::json::parse(report);
    EXPECT_TRUE(figures.contains("nearest_label"));
    uint32_t tiers = 0;
    EXPECT_EQ(haptoflow_model_tier_count(model_, &tiers), HAPTOFLOW_OK);
    EXPECT_EQ(figures.at("other_tiers").size(), tiers - 1U);

    const EngineHandle engine(createEngine(engineOptions(runtime_, model_)));
    uint32_t index = 0;
    EXPECT_EQ(haptoflow_engine_register_material(engine, text, std::strlen(text), &index), HAPTOFLOW_OK) << message();
    uint32_t labels = 0;
    EXPECT_EQ(haptoflow_model_label_count(model_, &labels), HAPTOFLOW_OK);
    EXPECT_EQ(index, labels);
}

TEST_F(LearningApiTest, ACancellationEndsLearningAndLeavesTheOutputUnchanged) {
    CancellationHandle cancellation;
    ASSERT_EQ(haptoflow_cancellation_create(cancellation.out()), HAPTOFLOW_OK);
    auto given = options();
    given.cancellation = cancellation;
    given.progress = [](void* context, double share, const char*) {
        if (share > 0.2) {
            EXPECT_EQ(haptoflow_cancellation_cancel(static_cast<haptoflow_cancellation*>(context)), HAPTOFLOW_OK);
        }
    };
    given.progress_context = cancellation;
    EXPECT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_CANCELLED);
    EXPECT_FALSE(learning_);
}

TEST_F(LearningApiTest, ARecordingWithoutMotionNeedsTheCallersSpeedAndForce) {
    auto reading = sized<haptoflow_recording_options>();
    reading.path = HAPTOFLOW_TEST_GOLDEN_DIR "/recordings/files/no_motion.csv";
    RecordingHandle recording;
    ASSERT_EQ(haptoflow_recording_read(&reading, recording.out()), HAPTOFLOW_OK) << message();
    auto given = learningOptions(recording, runtime_, model_);
    EXPECT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_RECORDING_UNUSABLE);
    EXPECT_THAT(message(), HasSubstr("no_motion.csv: no motion in it or beside it"));
    given.speed_mps = 0.08;
    EXPECT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_RECORDING_UNUSABLE);
    EXPECT_THAT(message(), HasSubstr("no_motion.csv: no force in it or beside it"));
    given.force_newtons = 1.0;
    EXPECT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_RECORDING_UNUSABLE);
    EXPECT_THAT(message(), HasSubstr("lasts 0.5 s")) << "nothing but the length is wrong";
}

TEST_F(LearningApiTest, OptionsOutOfRangeAreRefusedByName) {
    const std::array<float, 4> wild{1000.0F, 0.0F, 0.0F, 0.0F};
    using Change = std::function<void(haptoflow_learning_options&)>;
    const std::vector<std::pair<Change, const char*>> cases{
        {[](auto& given) { given.recording = nullptr; }, "recording"},
        {[](auto& given) { given.runtime = nullptr; }, ""},
        {[](auto& given) { given.name = "Denim"; }, "Denim"},
        {[](auto& given) { given.seconds_limit = -1.0; }, "seconds_limit"},
        {[](auto& given) { given.tier = "none"; }, "none"},
        {[&](auto& given) { given.wave_vectors = wild.data(); }, "wave_vectors"},
    };
    for (const auto& [change, named] : cases) {
        auto given = options();
        change(given);
        EXPECT_EQ(haptoflow_learn_material(&given, learning_.out()), HAPTOFLOW_INVALID_ARGUMENT) << named;
        EXPECT_THAT(message(), HasSubstr(named));
    }
}

TEST_F(LearningApiTest, SamplesOutOfRangeAreRefusedByName) {
    using Change = std::function<void(haptoflow_recording_info&)>;
    const std::vector<std::pair<Change, const char*>> cases{
        {[](auto& info) { info.axis_count = 2; }, "2 axes"},
        {[](auto& info) { info.acceleration_mps2 = nullptr; }, "acceleration_mps2"},
        {[](auto& info) { info.sample_count = ~uint64_t{0}; }, "sample_count"},
        {[](auto& info) {
             info.force_newtons = nullptr;
             info.constant_force_newtons = -1.0;
         },
         "-1 N"},
    };
    for (const auto& [change, named] : cases) {
        haptoflow_recording_info info = infoOf(made_);
        change(info);
        haptoflow_recording* recording = nullptr;
        EXPECT_EQ(haptoflow_recording_create(&info, &recording), HAPTOFLOW_INVALID_ARGUMENT) << named;
        EXPECT_THAT(message(), HasSubstr(named));
    }
    std::array<float, 8> numbers{};
    EXPECT_EQ(haptoflow_resample(numbers.data(), 2, 2000.0, numbers.data(), 8, 1e9), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("expected 1000 to 192000 Hz"));
}

TEST(RecordingApiTest, ARecordingOfSamplesKeepsThemAndItsTexts) {
    const std::array<float, 4> wave{1.0F, 2.0F, 3.0F, 4.0F};
    const std::array<float, 8> velocity{0.1F, 0.0F, 0.1F, 0.0F, 0.1F, 0.0F, 0.1F, 0.0F};
    auto given = sized<haptoflow_recording_info>();
    given.axis_count = 1;
    given.sample_rate_hz = 2000.0;
    given.sample_count = wave.size();
    given.acceleration_mps2 = wave.data();
    given.velocity_mps = velocity.data();
    given.constant_force_newtons = 1.5;
    given.label = "felt";
    given.licence = "CC0";
    given.provenance = "our hall";
    const RecordingHandle open(recordingOf(given));
    auto info = sized<haptoflow_recording_info>();
    ASSERT_EQ(haptoflow_recording_get_info(open, &info), HAPTOFLOW_OK) << message();
    EXPECT_EQ(info.sample_count, 4U);
    EXPECT_EQ(info.acceleration_mps2[3], 4.0F);
    EXPECT_EQ(info.velocity_mps[6], 0.1F);
    EXPECT_TRUE(std::isnan(info.constant_velocity_mps[0]));
    EXPECT_EQ(info.force_newtons, nullptr);
    EXPECT_EQ(info.constant_force_newtons, 1.5);
    EXPECT_EQ(std::string(info.label) + info.licence + info.provenance + info.material_name, "feltCC0our hall");
}

TEST(RecordingApiTest, TheWaveIsOneAxisWithoutGravityAndSilentBeyondTheEnd) {
    constexpr double inputHz = 4000.0;
    constexpr std::size_t samples = 4000;
    const std::vector<float> tone = haptoflow::testing::sine(150.0, 3.0, 1.0, inputHz);
    std::vector<float> recorded(3 * samples, 0.0F);
    for (std::size_t i = 0; i < samples; ++i) {
        recorded[3 * i + 1] = tone[i];
        recorded[3 * i + 2] = 9.81F;
    }
    auto given = sized<haptoflow_recording_info>();
    given.axis_count = 3;
    given.sample_rate_hz = inputHz;
    given.sample_count = samples;
    given.acceleration_mps2 = recorded.data();
    const RecordingHandle open(recordingOf(given));
    std::vector<float> wave(2100, 1.0F);
    ASSERT_EQ(haptoflow_recording_wave(open, wave.data(), wave.size()), HAPTOFLOW_OK) << message();
    for (std::size_t i = 500; i < 1500; i += 7) {
        EXPECT_NEAR(wave[i], tone[2 * i], 0.05F) << i;
    }
    EXPECT_EQ(wave.back(), 0.0F) << "beyond the recording's end";
}

TEST(RecordingApiTest, TheNoiseAtRestIsRemovedAndToldAndNothingButNoiseRefused) {
    constexpr std::size_t samples = 8000;
    for (const float slidingGain : {10.0F, 1.0F}) {
        std::vector<float> wave(samples);
        std::vector<float> velocity(2 * samples);
        const std::vector<float> force(samples, 1.0F);
        skeleton::fillStandardNormal({.seed = 5, .voice = 0, .segment = 0}, wave);
        for (std::size_t i = 0; i < samples; ++i) {
            const bool slides = i >= samples / 2;
            wave[i] *= slides ? 0.04F * slidingGain : 0.04F;
            velocity[2 * i] = slides ? 0.1F : 0.0F;
        }
        wave[1000] = std::numeric_limits<float>::quiet_NaN();
        haptoflow_noise_source source = HAPTOFLOW_NOISE_QUIET_PART;
        double noiseMps2 = 0.0;
        const haptoflow_status status = haptoflow_recording_remove_noise(wave.data(), velocity.data(), force.data(),
                                                                         wave.size(), &source, &noiseMps2);
        if (slidingGain == 1.0F) {
            EXPECT_EQ(status, HAPTOFLOW_RECORDING_UNUSABLE);
            EXPECT_THAT(message(), HasSubstr("no stronger where the tip slides"));
            continue;
        }
        ASSERT_EQ(status, HAPTOFLOW_OK) << message();
        EXPECT_EQ(source, HAPTOFLOW_NOISE_REST);
        EXPECT_NEAR(noiseMps2, 0.04, 0.003);
        EXPECT_TRUE(std::isnan(wave[1000])) << "the mark between two recordings stays";
        EXPECT_LT(std::abs(wave[2500]), 0.04F);
    }
}

}  // namespace
}  // namespace haptoflow::capi::testing
