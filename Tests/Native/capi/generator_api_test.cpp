#include "inference/rebuilt_model.hpp"
#include "inference/rib_graph.hpp"
#include "open_engine.hpp"
#include "open_handles.hpp"
#include "support/dynamic_library.hpp"

#include <onnxruntime_c_api.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <thread>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using ::testing::HasSubstr;

constexpr std::size_t samples = HAPTOFLOW_SEGMENT_SAMPLES;

std::vector<float> flat(const nlohmann::json& rows) {
    std::vector<float> values;
    for (const auto& row : rows) {
        const auto part = row.get<std::vector<float>>();
        values.insert(values.end(), part.begin(), part.end());
    }
    return values;
}

/// The golden requests as flat arrays of the C interface, with the expected results.
struct Golden {
    Golden() {
        std::ifstream stream(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.expected.json");
        const nlohmann::json json = nlohmann::json::parse(stream);
        const auto& requests = json.at("requests");
        embeddings = flat(requests.at("embedding"));
        motions = flat(requests.at("motion"));
        previous = flat(requests.at("previous"));
        noise = flat(requests.at("noise"));
        for (const auto& row : json.at("cases")) {
            if (row.at("tier") == "standard" && row.at("solver") == "midpoint" && row.at("steps") == 3) {
                segments = flat(row.at("segments_mps2"));
                levels = row.at("levels_mps2").get<std::vector<float>>();
            }
        }
        EXPECT_EQ(segments.size(), 3 * samples);
    }

    [[nodiscard]] haptoflow_batch batch() const {
        return {sizeof(haptoflow_batch),
                3,
                embeddings.data(),
                motions.data(),
                previous.data(),
                noise.data(),
                nullptr,
                nullptr,
                nullptr};
    }

    std::vector<float> embeddings;
    std::vector<float> motions;
    std::vector<float> previous;
    std::vector<float> noise;
    std::vector<float> segments;
    std::vector<float> levels;
};

class GeneratorApiTest : public WithTinyModel {
protected:
    void TearDown() override {
        EXPECT_EQ(haptoflow_generator_close(&generator_), HAPTOFLOW_OK);
        WithTinyModel::TearDown();
    }

    void create(haptoflow_generator_options options) {
        ASSERT_EQ(haptoflow_generator_create(&options, &generator_), HAPTOFLOW_OK) << message();
    }

    void createMidpointOfThreeSteps() {
        create(generatorOptions("standard"));
        ASSERT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_MIDPOINT, 3), HAPTOFLOW_OK);
    }

    void expectGoldenSegments() {
        std::vector<float> segments(3 * samples);
        const haptoflow_batch batch = golden_.batch();
        ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_OK) << message();
        for (std::size_t index = 0; index < segments.size(); ++index) {
            ASSERT_NEAR(segments[index], golden_.segments[index], 1e-5F * golden_.levels[index / samples]) << index;
        }
    }

    Golden golden_;
    haptoflow_generator* generator_ = nullptr;
};

TEST_F(GeneratorApiTest, TheSolverCanBeChangedAndResetToTheTiersOwn) {
    createMidpointOfThreeSteps();
    expectGoldenSegments();
    ASSERT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_OF_TIER, 0), HAPTOFLOW_OK);
    std::vector<float> segments(3 * samples);
    const haptoflow_batch batch = golden_.batch();
    ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_OK);
    EXPECT_NE(segments, golden_.segments);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_OF_TIER, 2), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_EULER, 17), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, 9, 1), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(GeneratorApiTest, TheNoiseOfALatentIsRefusedByATierThatHasNone) {
    createMidpointOfThreeSteps();
    std::vector<float> segments(3 * samples);
    haptoflow_batch batch = golden_.batch();
    batch.latent_noise = segments.data();
    EXPECT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("latent_noise"));
}

TEST_F(GeneratorApiTest, AGeneratorOutlivesItsRuntimeAndItsModel) {
    createMidpointOfThreeSteps();
    ASSERT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_runtime_close(&runtime_), HAPTOFLOW_OK);
    expectGoldenSegments();
}

TEST_F(GeneratorApiTest, AGeneratorServesThreadsOneAfterTheOther) {
    createMidpointOfThreeSteps();
    std::array<std::vector<float>, 3> results;
    std::vector<std::thread> threads;
    for (auto& result : results) {
        threads.emplace_back([this, &result] {
            for (int round = 0; round < 20; ++round) {
                std::vector<float> segments(3 * samples);
                const haptoflow_batch batch = golden_.batch();
                if (haptoflow_generator_generate(generator_, &batch, segments.data()) != HAPTOFLOW_OK) {
                    return;
                }
                result = segments;
            }
        });
    }
    for (auto& thread : threads) {
        thread.join();
    }
    EXPECT_EQ(results[0].size(), 3 * samples);
    EXPECT_EQ(results[0], results[1]);
    EXPECT_EQ(results[0], results[2]);
}

TEST_F(GeneratorApiTest, NoiseThatIsNotFiniteIsAnInferenceFailure) {
    createMidpointOfThreeSteps();
    golden_.noise[5] = std::nanf("");
    std::vector<float> segments(3 * samples);
    const haptoflow_batch batch = golden_.batch();
    EXPECT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_INFERENCE_FAILED);
    EXPECT_THAT(message(), HasSubstr("not finite"));
}

TEST_F(GeneratorApiTest, AnUnknownTierIsRefused) {
    const auto options = generatorOptions("ultra");
    EXPECT_EQ(haptoflow_generator_create(&options, &generator_), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("\"ultra\""));
    EXPECT_EQ(generator_, nullptr);
}

TEST_F(GeneratorApiTest, ABatchAboveTheLimitIsRefused) {
    auto options = generatorOptions();
    options.maximum_batch = HAPTOFLOW_MAXIMUM_BATCH + 1;
    EXPECT_EQ(haptoflow_generator_create(&options, &generator_), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(RuntimeApiTest, TheApiBaseOfALibraryLoadedByTheCallerIsAccepted) {
    // Never closed, so that a leak checker still knows the library whose memory ONNX Runtime keeps until the end.
    static const auto& library = *new haptoflow::testing::DynamicLibrary(HAPTOFLOW_TEST_ONNXRUNTIME);
    const auto getApiBase = library.function<const OrtApiBase* (*)()>("OrtGetApiBase");
    const haptoflow_runtime_options options{sizeof(options), getApiBase(), nullptr, nullptr, nullptr};
    haptoflow_runtime* runtime = nullptr;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
}

TEST(RuntimeApiTest, TheErrorForAMissingLibraryNamesIt) {
    const haptoflow_runtime_options options{sizeof(options), nullptr, "/nowhere/libonnxruntime.so", nullptr, nullptr};
    haptoflow_runtime* runtime = nullptr;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_RUNTIME_UNAVAILABLE);
    EXPECT_THAT(message(), ::testing::StartsWith("/nowhere/libonnxruntime.so"));
    EXPECT_EQ(runtime, nullptr);
}

}  // namespace
}  // namespace haptoflow::capi::testing

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
