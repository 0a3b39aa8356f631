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
    void createMidpointOfThreeSteps() {
        const auto options = generatorOptions(runtime_, model_, "standard");
        ASSERT_EQ(haptoflow_generator_create(&options, generator_.out()), HAPTOFLOW_OK) << message();
        ASSERT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_MIDPOINT, 3), HAPTOFLOW_OK);
    }

    /// Generates into `segments_`.
    haptoflow_status generate(const haptoflow_batch& batch) {
        return haptoflow_generator_generate(generator_, &batch, segments_.data());
    }

    void expectGoldenSegments() {
        ASSERT_EQ(generate(golden_.batch()), HAPTOFLOW_OK) << message();
        for (std::size_t index = 0; index < segments_.size(); ++index) {
            ASSERT_NEAR(segments_[index], golden_.segments[index], 1e-5F * golden_.levels[index / samples]) << index;
        }
    }

    Golden golden_;
    GeneratorHandle generator_;
    std::vector<float> segments_ = std::vector<float>(3 * samples);
};

TEST_F(GeneratorApiTest, TheSolverCanBeChangedAndResetToTheTiersOwn) {
    createMidpointOfThreeSteps();
    expectGoldenSegments();
    ASSERT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_OF_TIER, 0), HAPTOFLOW_OK);
    ASSERT_EQ(generate(golden_.batch()), HAPTOFLOW_OK);
    EXPECT_NE(segments_, golden_.segments);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_OF_TIER, 2), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_EULER, 17), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_generator_set_solver(generator_, 9, 1), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(GeneratorApiTest, TheNoiseOfALatentIsRefusedByATierThatHasNone) {
    createMidpointOfThreeSteps();
    haptoflow_batch batch = golden_.batch();
    batch.latent_noise = segments_.data();
    EXPECT_EQ(generate(batch), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("latent_noise"));
}

TEST_F(GeneratorApiTest, AGeneratorOutlivesItsRuntimeAndItsModel) {
    createMidpointOfThreeSteps();
    ASSERT_EQ(haptoflow_model_close(model_.out()), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_runtime_close(runtime_.out()), HAPTOFLOW_OK);
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
    EXPECT_EQ(generate(golden_.batch()), HAPTOFLOW_INFERENCE_FAILED);
    EXPECT_THAT(message(), HasSubstr("not finite"));
}

TEST_F(GeneratorApiTest, AnUnknownTierIsRefused) {
    const auto options = generatorOptions(runtime_, model_, "ultra");
    EXPECT_EQ(haptoflow_generator_create(&options, generator_.out()), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("\"ultra\""));
    EXPECT_FALSE(generator_);
}

TEST_F(GeneratorApiTest, ABatchAboveTheLimitIsRefused) {
    auto options = generatorOptions(runtime_, model_);
    options.maximum_batch = HAPTOFLOW_MAXIMUM_BATCH + 1;
    EXPECT_EQ(haptoflow_generator_create(&options, generator_.out()), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(RuntimeApiTest, TheApiBaseOfALibraryLoadedByTheCallerIsAccepted) {
    // Never closed, so that a leak checker still knows the library whose memory ONNX Runtime keeps until the end.
    static const auto& library = *new haptoflow::testing::DynamicLibrary(HAPTOFLOW_TEST_ONNXRUNTIME);
    const auto getApiBase = library.function<const OrtApiBase* (*)()>("OrtGetApiBase");
    auto options = sized<haptoflow_runtime_options>();
    options.ort_api_base = getApiBase();
    RuntimeHandle runtime;
    EXPECT_EQ(haptoflow_runtime_open(&options, runtime.out()), HAPTOFLOW_OK) << message();
}

TEST(RuntimeApiTest, TheErrorForAMissingLibraryNamesIt) {
    auto options = sized<haptoflow_runtime_options>();
    options.library_path = "/nowhere/libonnxruntime.so";
    haptoflow_runtime* runtime = nullptr;
    EXPECT_EQ(haptoflow_runtime_open(&options, &runtime), HAPTOFLOW_RUNTIME_UNAVAILABLE);
    EXPECT_THAT(message(), ::testing::StartsWith("/nowhere/libonnxruntime.so"));
    EXPECT_EQ(runtime, nullptr);
}

// A model with the tiers `sketch` (kind `skeleton`) and `standard` (kind `refine`), with and without ONNX Runtime.

class SkeletonApiTest : public ::testing::Test {
protected:
    haptoflow_status createEngine(haptoflow_quality quality, bool hasWorker = false) {
        const auto options = engineOptions(nullptr, model_, quality, hasWorker);
        return haptoflow_engine_create(&options, engine_.out());
    }

    ModelHandle model_{openModel(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow")};
    EngineHandle engine_;
    GeneratorHandle generator_;
};

TEST_F(SkeletonApiTest, TheKindsOfTheTiersAreTold) {
    auto info = sized<haptoflow_tier_info>();
    ASSERT_EQ(haptoflow_model_tier(model_, 0, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.kind, "skeleton");
    EXPECT_EQ(info.steps, 1);
    ASSERT_EQ(haptoflow_model_tier(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.kind, "refine");
}

TEST_F(SkeletonApiTest, ASketchLoadsAndPlaysWithoutOnnxRuntime) {
    ASSERT_EQ(createEngine(HAPTOFLOW_QUALITY_SKETCH), HAPTOFLOW_OK) << message();
    for (const uint32_t label : {0U, 1U}) {
        haptoflow_voice voice = 0;
        ASSERT_EQ(haptoflow_voice_create(engine_, 48000.0, &voice), HAPTOFLOW_OK) << message();
        haptoflow_contact_state state = slidingState();
        state.labels[0] = label;
        std::vector<float> sound(667);
        for (int update = 0; update < 36; ++update) {
            ASSERT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK) << message();
            ASSERT_EQ(haptoflow_voice_render(voice, sound.data(), 1, 1, 0, 48000.0), HAPTOFLOW_OK);
            ASSERT_EQ(haptoflow_engine_step(engine_), HAPTOFLOW_OK) << message();
            ASSERT_EQ(haptoflow_voice_render(voice, sound.data() + 1, 666, 1, 0, 48000.0), HAPTOFLOW_OK);
            EXPECT_TRUE(allFinite(sound));
        }
        EXPECT_GT(peak(sound), 1e-4F) << label;
        EXPECT_EQ(statisticsOf(voice).inferences, 36U);
        EXPECT_EQ(statisticsOf(voice).underruns, 0U);
    }
}

TEST_F(SkeletonApiTest, AutomaticQualityWithoutOnnxRuntimeTakesTheSketch) {
    ASSERT_EQ(createEngine(HAPTOFLOW_QUALITY_AUTO, true), HAPTOFLOW_OK) << message();
    EXPECT_EQ(statisticsOf(engine_).tier, 0U);
    EXPECT_EQ(statisticsOf(engine_).is_measuring, 0U);
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
    const auto options = generatorOptions(nullptr, model_, "sketch");
    ASSERT_EQ(haptoflow_generator_create(&options, generator_.out()), HAPTOFLOW_OK) << message();
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
