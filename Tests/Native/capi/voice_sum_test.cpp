// Several voices on one output: haptoflow_voices_render. Voices of engines with one seed have one waveform, so that the
// sum of two of them is known.
#include "open_engine.hpp"

#include "dsp/limiter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using ::testing::Each;

constexpr uint32_t frames = 512;
/// No sample reaches the knee.
constexpr double linearMps2 = 1e6;
/// Most samples of one voice lie above the knee.
constexpr double loudMps2 = 1.0;

class VoiceSumTest : public ::testing::Test {
protected:
    VoiceSumTest() {
        const haptoflow_model_options options{sizeof(options), nullptr, 0, defaultModelPath.c_str()};
        EXPECT_EQ(haptoflow_model_open(&options, &model_), HAPTOFLOW_OK) << message();
    }
    ~VoiceSumTest() override {
        for (haptoflow_engine*& engine : engines_) {
            EXPECT_EQ(haptoflow_engine_close(&engine), HAPTOFLOW_OK);
        }
        EXPECT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_runtime_close(&runtime_), HAPTOFLOW_OK);
    }

    /// A voice that begins to slide in its next block, the first of an engine of its own.
    haptoflow_voice slidingVoice(double fullScaleMps2, float ceiling = 1.0F) {
        haptoflow_engine_options options{};
        options.struct_size = sizeof(options);
        options.quality = HAPTOFLOW_QUALITY_DRAFT;
        options.runtime = runtime_;
        options.model = model_;
        options.seed = 1;
        options.without_worker = 1;
        options.fixed_lead_ms = 8.0;
        options.full_scale_mps2 = fullScaleMps2;
        EXPECT_EQ(haptoflow_engine_create(&options, &engines_.emplace_back()), HAPTOFLOW_OK) << message();
        haptoflow_voice voice = 0;
        const haptoflow_contact_state state = slidingState(0.3F, 3.0F);
        EXPECT_EQ(haptoflow_voice_create(engines_.back(), 48000.0, &voice), HAPTOFLOW_OK) << message();
        EXPECT_EQ(haptoflow_voice_set_ceiling(voice, ceiling), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK);
        return voice;
    }

    static std::vector<float> sumOf(std::vector<haptoflow_voice>& voices) {
        std::vector<float> samples(frames, 9.0F);
        EXPECT_EQ(haptoflow_voices_render(voices.data(), static_cast<uint32_t>(voices.size()), samples.data(), frames,
                                          1, 0, 48000.0),
                  HAPTOFLOW_OK);
        return samples;
    }
    static std::vector<float> sumOf(std::vector<haptoflow_voice>&& voices) { return sumOf(voices); }

    static std::vector<float> alone(haptoflow_voice voice) {
        std::vector<float> samples(frames, 9.0F);
        EXPECT_EQ(haptoflow_voice_render(voice, samples.data(), frames, 1, 0, 48000.0), HAPTOFLOW_OK);
        return samples;
    }

    /// What a voice plays, in m/s^2.
    std::vector<float> waveMps2() {
        std::vector<float> wave = alone(slidingVoice(linearMps2));
        std::ranges::transform(wave, wave.begin(), [](float share) { return share * static_cast<float>(linearMps2); });
        return wave;
    }
    /// The limiter's curve on a wave times `scale`.
    static std::vector<float> limited(std::vector<float> wave, float scale) {
        std::ranges::transform(wave, wave.begin(), [scale](float sample) { return scale * sample; });
        dsp::SoftLimiter(1.0F).processScaled(wave);
        return wave;
    }

    haptoflow_runtime* runtime_ = openRuntime();
    haptoflow_model* model_ = nullptr;
    std::vector<haptoflow_engine*> engines_;
};

TEST_F(VoiceSumTest, TwoVoicesPassTheCurveOnceAsASumAndAreNotClipped) {
    const std::vector<float> wave = waveMps2();
    const std::vector<float> sum = sumOf({slidingVoice(loudMps2), slidingVoice(loudMps2)});
    ASSERT_GT(peak(wave), 1.5F) << "each would be limited alone";
    const std::vector<float> expected = limited(wave, 2.0F / static_cast<float>(loudMps2));
    for (std::size_t i = 0; i < frames; ++i) {
        ASSERT_NEAR(sum[i], expected[i], 1e-5F) << i;
    }
    EXPECT_LT(peak(sum), 1.0F);
}

TEST_F(VoiceSumTest, ThreeVoicesOfDifferentFullScalesEachKeepTheirOwn) {
    const std::vector<float> wave = waveMps2();
    const std::vector<float> sum = sumOf({slidingVoice(loudMps2), slidingVoice(4.0), slidingVoice(linearMps2)});
    const std::vector<float> expected = limited(wave, 1.0F + 0.25F + static_cast<float>(1.0 / linearMps2));
    for (std::size_t i = 0; i < frames; ++i) {
        ASSERT_NEAR(sum[i], expected[i], 1e-5F) << i;
    }
}

TEST_F(VoiceSumTest, TheLowestCeilingLimitsTheSumAndACeilingOf0SilencesItsOwnVoiceOnly) {
    EXPECT_LT(peak(sumOf({slidingVoice(loudMps2), slidingVoice(loudMps2, 0.25F)})), 0.25F);
    const std::vector<float> own = alone(slidingVoice(loudMps2));
    EXPECT_EQ(sumOf({slidingVoice(loudMps2, 0.0F), slidingVoice(loudMps2)}), own);
    EXPECT_THAT(sumOf({slidingVoice(loudMps2, 0.0F), slidingVoice(loudMps2, 0.0F)}), Each(0.0F));
}

TEST_F(VoiceSumTest, WithoutAVoiceZerosAreWrittenAndWhatHasEndedIsForgotten) {
    EXPECT_THAT(sumOf({}), Each(0.0F));
    haptoflow_voice destroyed = slidingVoice(loudMps2);
    const haptoflow_voice kept = slidingVoice(loudMps2);
    std::vector<haptoflow_voice> voices{destroyed, kept};
    (void)sumOf(voices);
    ASSERT_EQ(haptoflow_voice_destroy(&destroyed), HAPTOFLOW_OK);
    (void)sumOf(voices);
    (void)sumOf(voices);
    EXPECT_EQ(voices, (std::vector<haptoflow_voice>{0, kept})) << "once it has faded";
}

TEST_F(VoiceSumTest, OneOfTwoVoicesThatEndsFadesInTheSumWithoutAStep) {
    haptoflow_voice destroyed = slidingVoice(loudMps2);
    const haptoflow_voice kept = slidingVoice(loudMps2);
    std::vector<haptoflow_voice> voices{destroyed, kept};
    std::vector<float> output = sumOf(voices);
    const float usual = largestStep(output);
    ASSERT_EQ(haptoflow_voice_destroy(&destroyed), HAPTOFLOW_OK);
    for (int block = 0; block < 3; ++block) {
        const std::vector<float> next = sumOf(voices);
        output.insert(output.end(), next.begin(), next.end());
    }
    EXPECT_LE(largestStep(output), 1.5F * usual);
    EXPECT_GT(peak(std::vector<float>(output.end() - 100, output.end())), 0.1F) << "the other one goes on";
}

TEST_F(VoiceSumTest, BlocksOfAnyLengthAndOneChannelOfSeveralAreWritten) {
    std::vector<haptoflow_voice> voices{slidingVoice(loudMps2), slidingVoice(loudMps2)};
    std::vector<float> interleaved(2 * 20'000, 9.0F);
    ASSERT_EQ(haptoflow_voices_render(voices.data(), 2, interleaved.data(), 20'000, 2, 1, 48000.0), HAPTOFLOW_OK);
    float loudest = 0.0F;
    for (std::size_t frame = 0; frame < 20'000; ++frame) {
        ASSERT_EQ(interleaved[2 * frame], 9.0F);
        loudest = std::max(loudest, std::abs(interleaved[2 * frame + 1]));
    }
    EXPECT_GT(loudest, 0.7F);
    EXPECT_LT(loudest, 1.0F);
    EXPECT_EQ(haptoflow_voices_render(nullptr, 2, interleaved.data(), 8, 2, 1, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voices_render(voices.data(), 2, interleaved.data(), 8, 2, 2, 48000.0),
              HAPTOFLOW_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace haptoflow::capi::testing
