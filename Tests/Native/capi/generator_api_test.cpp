#include "c11_user.h"
#include "inference/rebuilt_model.hpp"
#include "inference/rib_graph.hpp"
#include "open_handles.hpp"
#include "support/dynamic_library.hpp"

#include <nlohmann/json.hpp>

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <thread>

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

TEST(CUserTest, AC11ProgramGeneratesASegment) {
    std::array<float, samples> segment{};
    ASSERT_EQ(generateOneSegmentFromC(HAPTOFLOW_TEST_ONNXRUNTIME, tinyModelPath.c_str(), segment.data()), HAPTOFLOW_OK)
        << message();
    EXPECT_TRUE(std::any_of(segment.begin(), segment.end(), [](float value) { return std::fabs(value) > 0.1F; }));
}

}  // namespace
}  // namespace haptoflow::capi::testing
