#include "open_engine.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

// A model with the tiers `sketch` (kind `skeleton`) and `standard` (kind `refine`), with and without ONNX Runtime.

namespace haptoflow::capi::testing {
namespace {

using ::testing::HasSubstr;

class SkeletonApiTest : public ::testing::Test {
protected:
    SkeletonApiTest() {
        const haptoflow_model_options options{sizeof(options), nullptr, 0,
                                              HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow"};
        EXPECT_EQ(haptoflow_model_open(&options, &model_), HAPTOFLOW_OK) << message();
    }
    void TearDown() override {
        EXPECT_EQ(haptoflow_engine_close(&engine_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_generator_close(&generator_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
    }

    haptoflow_status createEngine(haptoflow_quality quality, bool hasWorker = false,
                                  const haptoflow_runtime* runtime = nullptr) {
        haptoflow_engine_options options{};
        options.struct_size = sizeof(options);
        options.quality = quality;
        options.runtime = runtime;
        options.model = model_;
        options.seed = 1;
        options.without_worker = hasWorker ? 0 : 1;
        options.fixed_lead_ms = hasWorker ? 0.0 : 8.0;
        return haptoflow_engine_create(&options, &engine_);
    }

    /// Slides over a label for half a second; returns the sound after the first tenth.
    std::vector<float> slide(uint32_t label, float variation = 0.0F, uint32_t surfaceSeed = 0) {
        haptoflow_voice voice = 0;
        EXPECT_EQ(haptoflow_voice_create(engine_, 48000.0, &voice), HAPTOFLOW_OK) << message();
        haptoflow_contact_state state = slidingState();
        state.labels[0] = label;
        state.surface_seed = surfaceSeed;
        state.variation = variation;
        std::vector<float> sound;
        for (int update = 0; update < 36; ++update) {
            EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK) << message();
            std::vector<float> block(667);
            EXPECT_EQ(haptoflow_voice_render(voice, block.data(), 1, 1, 0, 48000.0), HAPTOFLOW_OK);
            EXPECT_EQ(haptoflow_engine_step(engine_), HAPTOFLOW_OK) << message();
            EXPECT_EQ(haptoflow_voice_render(voice, block.data() + 1, 666, 1, 0, 48000.0), HAPTOFLOW_OK);
            if (update >= 7) {
                sound.insert(sound.end(), block.begin(), block.end());
            }
        }
        haptoflow_voice_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        EXPECT_EQ(haptoflow_voice_get_statistics(voice, &statistics), HAPTOFLOW_OK);
        EXPECT_EQ(statistics.inferences, 36U);
        EXPECT_EQ(statistics.underruns, 0U);
        sanitised_ = statistics.sanitised;
        EXPECT_EQ(haptoflow_voice_destroy(&voice), HAPTOFLOW_OK);
        return sound;
    }

    haptoflow_model* model_ = nullptr;
    haptoflow_engine* engine_ = nullptr;
    haptoflow_generator* generator_ = nullptr;
    uint64_t sanitised_ = 0;
};

TEST_F(SkeletonApiTest, TheKindsOfTheTiersAreTold) {
    haptoflow_tier_info info{};
    info.struct_size = sizeof(info);
    ASSERT_EQ(haptoflow_model_tier(model_, 0, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.kind, "skeleton");
    EXPECT_EQ(info.steps, 1);
    ASSERT_EQ(haptoflow_model_tier(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.kind, "refine");
}

TEST_F(SkeletonApiTest, ASketchLoadsAndPlaysWithoutOnnxRuntime) {
    ASSERT_EQ(createEngine(HAPTOFLOW_QUALITY_SKETCH), HAPTOFLOW_OK) << message();
    for (const uint32_t label : {0U, 1U}) {
        const std::vector<float> sound = slide(label);
        EXPECT_TRUE(allFinite(sound));
        EXPECT_GT(peak(sound), 1e-4F) << label;
    }
}

TEST_F(SkeletonApiTest, AVariationMakesObjectsOfOneLabelDifferByTheirSeed) {
    const auto sound = [this](float variation, uint32_t seed) {
        // An engine of its own: the noise of a voice depends on the voices before it.
        EXPECT_EQ(createEngine(HAPTOFLOW_QUALITY_SKETCH), HAPTOFLOW_OK) << message();
        std::vector<float> samples = slide(0, variation, seed);
        EXPECT_EQ(haptoflow_engine_close(&engine_), HAPTOFLOW_OK);
        return samples;
    };
    const std::vector<float> mean = sound(0.0F, 1);
    EXPECT_EQ(sound(0.0F, 2), mean);
    const std::vector<float> first = sound(1.0F, 1);
    EXPECT_EQ(sanitised_, 0U);
    EXPECT_EQ(sound(1.0F, 1), first);
    EXPECT_NE(first, mean);
    EXPECT_NE(sound(1.0F, 2), first);
    EXPECT_EQ(sound(std::nanf(""), 1), mean);
    EXPECT_EQ(sanitised_, 36U);
}

TEST_F(SkeletonApiTest, AutomaticQualityWithoutOnnxRuntimeTakesTheSketch) {
    ASSERT_EQ(createEngine(HAPTOFLOW_QUALITY_AUTO, true), HAPTOFLOW_OK) << message();
    haptoflow_engine_statistics statistics{};
    statistics.struct_size = sizeof(statistics);
    ASSERT_EQ(haptoflow_engine_get_statistics(engine_, &statistics), HAPTOFLOW_OK);
    EXPECT_EQ(statistics.tier, 0U);
    EXPECT_EQ(statistics.is_measuring, 0U);
    EXPECT_EQ(haptoflow_engine_set_quality(engine_, HAPTOFLOW_QUALITY_AUTO), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_engine_set_quality(engine_, HAPTOFLOW_QUALITY_STANDARD), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("\"standard\" needs ONNX Runtime"));
}

TEST_F(SkeletonApiTest, ARefinedTierWithoutOnnxRuntimeIsRefused) {
    EXPECT_EQ(createEngine(HAPTOFLOW_QUALITY_STANDARD), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("not an open runtime handle"));
    EXPECT_THAT(message(), HasSubstr("\"standard\" needs ONNX Runtime"));
}

TEST_F(SkeletonApiTest, ARefinedTierPlays) {
    haptoflow_runtime* runtime = openRuntime();
    ASSERT_EQ(createEngine(HAPTOFLOW_QUALITY_STANDARD, false, runtime), HAPTOFLOW_OK) << message();
    const std::vector<float> sound = slide(1);
    EXPECT_TRUE(allFinite(sound));
    EXPECT_GT(peak(sound), 1e-4F);
    EXPECT_EQ(haptoflow_engine_close(&engine_), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
}

TEST_F(SkeletonApiTest, AGeneratorOfTheSketchReadsThePhasesOfABatch) {
    haptoflow_generator_options options{};
    options.struct_size = sizeof(options);
    options.model = model_;
    options.tier = "sketch";
    ASSERT_EQ(haptoflow_generator_create(&options, &generator_), HAPTOFLOW_OK) << message();
    std::mt19937 random(1);
    std::normal_distribution<float> normal;
    // Two requests that differ in their phases only, on the ruled label.
    std::vector<float> embeddings(2 * HAPTOFLOW_EMBEDDING_SIZE);
    ASSERT_EQ(haptoflow_model_embedding(model_, 1, embeddings.data()), HAPTOFLOW_OK);
    std::copy_n(embeddings.begin(), HAPTOFLOW_EMBEDDING_SIZE, embeddings.begin() + HAPTOFLOW_EMBEDDING_SIZE);
    const std::array<float, 6> motions{0.1F, 0.0F, 1.0F, 0.1F, 0.0F, 1.0F};
    std::vector<float> noise(2 * HAPTOFLOW_SEGMENT_SAMPLES);
    std::generate_n(noise.begin(), HAPTOFLOW_SEGMENT_SAMPLES, [&] { return normal(random); });
    std::copy_n(noise.begin(), HAPTOFLOW_SEGMENT_SAMPLES, noise.begin() + HAPTOFLOW_SEGMENT_SAMPLES);
    const std::vector<float> previous(noise.size());
    const std::array<float, 2 * HAPTOFLOW_PHASES> phases{0.0F, 0.0F, 0.0F, 80.0F, 0.0F, 0.0F,
                                                         0.5F, 0.0F, 0.0F, 80.0F, 0.0F, 0.0F};
    haptoflow_batch batch{
        sizeof(batch), 2,      embeddings.data(), motions.data(), previous.data(), noise.data(), phases.data(),
        nullptr,       nullptr};
    std::vector<float> segments(noise.size());
    ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_OK) << message();
    EXPECT_FALSE(std::equal(segments.begin(), segments.begin() + HAPTOFLOW_SEGMENT_SAMPLES,
                            segments.begin() + HAPTOFLOW_SEGMENT_SAMPLES));
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_HEUN, 4), HAPTOFLOW_OK) << message();
}

}  // namespace
}  // namespace haptoflow::capi::testing
