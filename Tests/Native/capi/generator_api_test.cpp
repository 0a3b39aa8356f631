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
        auto options = generatorOptions("standard");
        options.solver = HAPTOFLOW_SOLVER_MIDPOINT;
        options.steps = 3;
        create(options);
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

TEST_F(GeneratorApiTest, TheGoldenSegmentsAreReproduced) {
    createMidpointOfThreeSteps();
    expectGoldenSegments();
}

TEST_F(GeneratorApiTest, TheSolverCanBeChangedAndResetToTheTiersOwn) {
    create(generatorOptions());
    ASSERT_EQ(haptoflow_generator_set_solver(generator_, HAPTOFLOW_SOLVER_MIDPOINT, 3), HAPTOFLOW_OK);
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

TEST_F(GeneratorApiTest, TheNoiseOfALatentIsTheCallersWhereItIsGiven) {
    create(generatorOptions("latent"));
    constexpr std::size_t latent = 100;
    const std::vector<float> zeros(3 * samples);
    const std::vector<float> latentZeros(3 * latent);
    std::vector<float> derived(3 * samples);
    std::vector<float> given(3 * samples);
    std::vector<float> again(3 * samples);
    haptoflow_batch batch = golden_.batch();
    ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, derived.data()), HAPTOFLOW_OK) << message();
    batch.latent_noise = latentZeros.data();
    ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, given.data()), HAPTOFLOW_OK) << message();
    batch.noise = zeros.data();
    ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, again.data()), HAPTOFLOW_OK) << message();
    EXPECT_NE(given, derived);
    EXPECT_EQ(given, again) << "the segment's noise must not matter";
}

TEST_F(GeneratorApiTest, TheNoiseOfALatentIsRefusedByATierThatHasNone) {
    createMidpointOfThreeSteps();
    std::vector<float> segments(3 * samples);
    haptoflow_batch batch = golden_.batch();
    batch.latent_noise = segments.data();
    EXPECT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), HasSubstr("latent_noise"));
}

/// A copy of the tiny model whose direct tier returns its rib phase.
std::vector<std::byte> ribModelBytes() {
    const model::ModelFile tiny = model::ModelFile::read(tinyModelPath);
    return inference::testing::withGraphs(tiny,
                                          {{"direct_field", inference::testing::ribField("segment", {1, samples})}});
}

TEST_F(GeneratorApiTest, AStructSizeThatEndsWithinAPointerExcludesThePointer) {
    createMidpointOfThreeSteps();
    const Golden golden;
    std::vector<float> segments(3 * samples);
    std::array<float, 3 * HAPTOFLOW_PHASES> phases{};
    for (std::uint32_t bytes = 1; bytes < sizeof(void*); ++bytes) {
        haptoflow_batch batch = golden.batch();
        // Copying only the pointer's first bytes would make an invalid address.
        batch.phases = phases.data();
        batch.struct_size = static_cast<std::uint32_t>(offsetof(haptoflow_batch, phases)) + bytes;
        ASSERT_EQ(haptoflow_generator_generate(generator_, &batch, segments.data()), HAPTOFLOW_OK) << bytes;
        EXPECT_THAT(segments, ::testing::Pointwise(::testing::FloatNear(1e-4F), golden.segments)) << bytes;
    }
}

TEST(GeneratorRibPhaseTest, TheRibPhasesOfABatchReachTheGraphAndMissingOnesAreZero) {
    const Golden golden;
    const std::vector<std::byte> bytes = ribModelBytes();
    haptoflow_runtime* runtime = openRuntime();
    const haptoflow_model_options modelOptions{sizeof(modelOptions), bytes.data(), bytes.size(), nullptr};
    haptoflow_model* model = nullptr;
    ASSERT_EQ(haptoflow_model_open(&modelOptions, &model), HAPTOFLOW_OK) << message();
    haptoflow_generator_options options{};
    options.struct_size = sizeof(options);
    options.runtime = runtime;
    options.model = model;
    options.tier = "direct";
    haptoflow_generator* generator = nullptr;
    ASSERT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_OK) << message();

    std::array<float, 3 * HAPTOFLOW_PHASES> phases{};
    constexpr std::array<std::array<float, 2>, 3> turns{{{0.25F, 0.5F}, {0.9F, 0.0F}, {0.0F, 0.75F}}};
    for (std::size_t row = 0; row < turns.size(); ++row) {
        std::ranges::copy(turns[row], phases.begin() + static_cast<std::ptrdiff_t>(row * HAPTOFLOW_PHASES));
    }
    std::vector<float> segments(3 * samples);
    haptoflow_batch batch = golden.batch();
    batch.phases = phases.data();
    ASSERT_EQ(haptoflow_generator_generate(generator, &batch, segments.data()), HAPTOFLOW_OK) << message();
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const std::size_t row = i / samples;
        const float expected =
            inference::testing::firstRibWeight * turns[row][0] + inference::testing::secondRibWeight * turns[row][1];
        ASSERT_NEAR(segments[i] / golden.levels[row], expected, 1e-5F) << i;
    }
    // A caller compiled with a header that did not have phases.
    batch.struct_size = offsetof(haptoflow_batch, phases);
    ASSERT_EQ(haptoflow_generator_generate(generator, &batch, segments.data()), HAPTOFLOW_OK) << message();
    EXPECT_THAT(segments, ::testing::Each(0.0F));
    batch.struct_size = sizeof(batch);
    batch.phases = nullptr;
    ASSERT_EQ(haptoflow_generator_generate(generator, &batch, segments.data()), HAPTOFLOW_OK) << message();
    EXPECT_THAT(segments, ::testing::Each(0.0F));

    EXPECT_EQ(haptoflow_generator_close(&generator), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_model_close(&model), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_runtime_close(&runtime), HAPTOFLOW_OK);
}

TEST_F(GeneratorApiTest, LevelsNeedNoWaveforms) {
    create(generatorOptions());
    haptoflow_batch batch = golden_.batch();
    batch.previous_mps2 = nullptr;
    batch.noise = nullptr;
    std::vector<float> levels(3);
    ASSERT_EQ(haptoflow_generator_levels(generator_, &batch, levels.data()), HAPTOFLOW_OK) << message();
    for (std::size_t index = 0; index < levels.size(); ++index) {
        EXPECT_NEAR(levels[index] / golden_.levels[index], 1.0F, 1e-5F);
    }
    batch.struct_size = offsetof(haptoflow_batch, previous_mps2);
    EXPECT_EQ(haptoflow_generator_levels(generator_, &batch, levels.data()), HAPTOFLOW_OK) << message();
    EXPECT_EQ(haptoflow_generator_generate(generator_, &batch, levels.data()), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(GeneratorApiTest, AnOlderCallersOptionsWork) {
    auto options = generatorOptions("standard");
    options.struct_size = offsetof(haptoflow_generator_options, steps);
    options.steps = 77;
    options.maximum_batch = 99'999;
    create(options);
    std::vector<float> levels(3);
    const haptoflow_batch batch = golden_.batch();
    EXPECT_EQ(haptoflow_generator_levels(generator_, &batch, levels.data()), HAPTOFLOW_OK);
}

TEST_F(GeneratorApiTest, ANewerCallersOptionsWork) {
    struct {
        haptoflow_generator_options known;
        std::array<unsigned char, 64> later;
    } options{generatorOptions("standard"), {}};
    options.later.fill(0xAB);
    options.known.struct_size = sizeof(options);
    EXPECT_EQ(haptoflow_generator_create(&options.known, &generator_), HAPTOFLOW_OK) << message();
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
