#include "inference/load_limits.hpp"

#include "inference/onnx_runtime.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "model/model_builder.hpp"
#include "rebuilt_model.hpp"
#include "tiny_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <onnxruntime_c_api.h>

#include <thread>

// Limits of operators, time and memory while loading a tier, and cancellation.

namespace haptoflow::inference::testing {
namespace {

using model::testing::Bytes;
using model::testing::floatTensor;
using model::testing::integerAttribute;
using model::testing::integerTensor;
using model::testing::levelGraph;

model::ModelFile tinyWithLevel(const Bytes& level) {
    return model::ModelFile::parse(withGraphs(tinyModel(), {{"level", level}}));
}

OnnxSegmentGenerator loadDraft(const model::ModelFile& model, const LoadLimits& limits = {},
                               const std::shared_ptr<const Runtime>& runtime = testRuntime()) {
    return openNetwork(model, "draft", {SolverKind::euler, 1}, 8, limits, nullptr, runtime);
}

template <typename Error, typename Action>
std::string failureOf(Action action) {
    try {
        (void)action();
    } catch (const Error& error) {
        return error.what();
    }
    ADD_FAILURE() << "nothing failed";
    return {};
}

template <typename Error>
std::string failureOf(const model::ModelFile& model, const LoadLimits& limits = {}) {
    return failureOf<Error>([&] { return loadDraft(model, limits); });
}

TEST(LoadLimitsTest, AGraphWithALoopIsRejectedWithoutRunning) {
    EXPECT_THAT(failureOf<model::ModelError>(tinyWithLevel(model::testing::loopingLevel())),
                ::testing::StartsWith("tier \"draft\", graph \"level\": uses the operator \"Loop\""));
}

/// A graph of a few bytes that needs 14 GB.
Bytes inflatedLevel() {
    return levelGraph()
        .constant(integerTensor("size", {60'000, 60'000}))
        .apply("ConstantOfShape", {"size"}, {"zeros"})
        .apply("ReduceSum", {"zeros"}, {"nothing"}, {integerAttribute("keepdims", 0)})
        .apply("Add", {"weighted", "nothing"}, {"log_level"})
        .model()
        .written();
}

TEST(LoadLimitsTest, AConstantThatNeedsTooMuchMemoryIsRejected) {
    const Bytes graph = inflatedLevel();
    EXPECT_THAT(failureOf<model::ModelError>(tinyWithLevel(graph)),
                ::testing::StartsWith("tier \"draft\", graph \"level\": a run of 256 with at most 1088 MiB failed"));
}

TEST(LoadLimitsTest, AGraphThatAcceptsOnlyOneRequestIsRejectedWhileLoading) {
    // Through a fraction, so that the error shows only in a run.
    const Bytes graph = levelGraph()
                            .constant(floatTensor("shape", {2}, {1.0F, 1.0F}))
                            .apply("Floor", {"shape"}, {"floor"})
                            .apply("Cast", {"floor"}, {"size"}, {integerAttribute("to", 7)})
                            .apply("Reshape", {"weighted", "size"}, {"log_level"})
                            .model()
                            .written();
    EXPECT_THAT(failureOf<model::ModelError>(tinyWithLevel(graph)),
                ::testing::HasSubstr("a fixed batch of 1; the batch must be free"));
}

TEST(LoadLimitsTest, LevelsAreTabulatedInRunsOf256ForAnyBatchSize) {
    OnnxSegmentGenerator generator = loadDraft(tinyModel(), {}, countingRuntime());
    const std::vector<SegmentRequest> requests(640, goldenBatch().requests().front());
    std::vector<float> levels(requests.size());
    const int before = graphRuns;
    generator.levels(requests, levels);
    EXPECT_EQ(graphRuns, before + 3);
    EXPECT_THAT(levels, ::testing::Each(levels.front()));
}

TEST(LoadLimitsTest, ACancelledLoadThrows) {
    const auto cancellation = std::make_shared<Cancellation>();
    cancellation->cancel();
    EXPECT_EQ(failureOf<LoadCancelled>(tinyModel(), {.cancellation = cancellation}), "the load was cancelled");
}

TEST(LoadLimitsTest, ACancellationAfterTheLoadHasNoEffect) {
    const auto cancellation = std::make_shared<Cancellation>();
    OnnxSegmentGenerator generator = loadDraft(tinyModel(), {.cancellation = cancellation});
    cancellation->cancel();
    std::vector<float> segments(3 * segmentSamples);
    EXPECT_NO_THROW(generator.generate(goldenBatch().requests(), segments));
}

TEST(LoadLimitsTest, ATierWhoseProbeRunTakesTooLongIsRejectedByNameAndAnotherLoadIsNot) {
    const model::ModelFile slow = tinyWithLevel(model::testing::slowLevel());
    std::thread other([&] {
        for (int load = 0; load < 2; ++load) {
            EXPECT_NO_THROW((void)loadDraft(tinyModel()));
        }
    });
    EXPECT_THAT(failureOf<TierTooSlow>(slow, {.probeLimitMs = 2.0}),
                ::testing::StartsWith("tier \"draft\", graph \"level\": a run of 256 took longer than 64 ms"));
    other.join();
}

TEST(CancellationTest, AnActionRunsOnceOnCancellation) {
    Cancellation cancellation;
    int runs = 0;
    const CancellationAction action(&cancellation, [&] { ++runs; });
    EXPECT_EQ(runs, 0);
    cancellation.cancel();
    cancellation.cancel();
    EXPECT_EQ(runs, 1);
}

TEST(CancellationTest, ALateActionRunsAtOnceAndADestroyedActionNever) {
    Cancellation cancellation;
    int gone = 0;
    {
        const CancellationAction action(&cancellation, [&] { ++gone; });
    }
    cancellation.cancel();
    EXPECT_EQ(gone, 0);
    int late = 0;
    const CancellationAction action(&cancellation, [&] { ++late; });
    EXPECT_EQ(late, 1);
    const CancellationAction none(nullptr, [&] { ++late; });
    EXPECT_EQ(late, 1);
}

/// The test's ONNX Runtime presented as version 1.16, without newer functions.
class OldRuntime {
public:
    static std::shared_ptr<const Runtime> open() {
        const auto newest = testRuntime();
        real() = newest->api();
        // Functions added after 1.16 are missing.
        real().SetUserLoggingFunction = nullptr;
        real().SessionOptionsSetLoadCancellationFlag = nullptr;
        static const OrtApiBase base{
            [](std::uint32_t version) noexcept -> const OrtApi* { return version <= 16 ? &real() : nullptr; },
            []() noexcept -> const char* { return "1.16.3"; }};
        return Runtime::fromApiBase(&base);
    }

private:
    static OrtApi& real() {
        static OrtApi api{};
        return api;
    }
};

TEST(OldRuntimeTest, ATierGivesTheSameResultWithVersion116) {
    const auto answer = [](OnnxSegmentGenerator generator) {
        std::vector<float> segments(3 * segmentSamples);
        generator.generate(goldenBatch().requests(), segments);
        return segments;
    };
    EXPECT_EQ(OldRuntime::open()->apiVersion(), 16U);
    EXPECT_EQ(testRuntime()->apiVersion(), 22U);
    EXPECT_EQ(answer(loadDraft(tinyModel(), {}, OldRuntime::open())), answer(loadDraft(tinyModel())));
}

/// The test's ONNX Runtime with a cancellation during the loading of a graph.
class RuntimeCancelledWhileLoading {
public:
    static std::shared_ptr<const Runtime> open(const std::shared_ptr<Cancellation>& cancellation) {
        state() = State{.cancellation = cancellation, .api = testRuntime()->api()};
        state().api.CreateSessionFromArray = createSession;
        state().api.SessionOptionsSetLoadCancellationFlag = setFlag;
        static const OrtApiBase base{[](std::uint32_t) noexcept -> const OrtApi* { return &state().api; },
                                     []() noexcept -> const char* { return "1.22.0"; }};
        return Runtime::fromApiBase(&base);
    }
    static int flagsSet() { return state().flagsSet; }
    static int sessionsMade() { return state().sessionsMade; }

private:
    struct State {
        std::shared_ptr<Cancellation> cancellation;
        OrtApi api{};
        int flagsSet = 0;
        int sessionsMade = 0;
    };
    static State& state() {
        static State each;
        return each;
    }
    static OrtStatus* ORT_API_CALL createSession(const OrtEnv* environment, const void* bytes, std::size_t count,
                                                 const OrtSessionOptions* options, OrtSession** session) noexcept {
        state().cancellation->cancel();
        OrtStatus* status = testRuntime()->api().CreateSessionFromArray(environment, bytes, count, options, session);
        state().sessionsMade += status == nullptr ? 1 : 0;
        return status;
    }
    static OrtStatus* ORT_API_CALL setFlag(OrtSessionOptions* options, bool isCancelled) noexcept {
        ++state().flagsSet;
        return testRuntime()->api().SessionOptionsSetLoadCancellationFlag(options, isCancelled);
    }
};

TEST(LoadLimitsTest, ACancellationIsForwardedToALoadingOnnxRuntime) {
    if (testRuntime()->apiVersion() < 22) {
        GTEST_SKIP() << "this version of ONNX Runtime cannot cancel a load";
    }
    const auto cancellation = std::make_shared<Cancellation>();
    const auto runtime = RuntimeCancelledWhileLoading::open(cancellation);
    EXPECT_THROW((void)loadDraft(tinyModel(), {.cancellation = cancellation}, runtime), LoadCancelled);
    EXPECT_EQ(RuntimeCancelledWhileLoading::flagsSet(), 1);
    EXPECT_EQ(RuntimeCancelledWhileLoading::sessionsMade(), 0);
}

// Models whose graphs do not match the format. The graphs are blobs of tiny.haptoflow that no tier uses.

model::ModelFile modelWith(const std::string& fieldBlob, const std::string& levelBlob,
                           const std::string& kind = "flow") {
    model::testing::ModelBuilder builder;
    for (auto& blob : builder.blobs) {
        if (blob.name == "field" || blob.name == "level") {
            const auto graph = tinyModel().blob(blob.name == "field" ? fieldBlob : levelBlob);
            blob.bytes = Bytes(graph.begin(), graph.end());
        }
    }
    builder.header["tiers"][0]["kind"] = kind;
    return model::ModelFile::parse(builder.build());
}

void expectRefused(const std::string& fieldBlob, const std::string& levelBlob, const std::string& part,
                   const std::string& kind = "flow") {
    try {
        (void)loadDraft(modelWith(fieldBlob, levelBlob, kind));
        ADD_FAILURE() << fieldBlob << " and " << levelBlob << " were accepted";
    } catch (const model::ModelError& error) {
        EXPECT_EQ(error.status(), model::ModelStatus::inconsistent);
        EXPECT_THAT(error.what(), ::testing::StartsWith("tier \"draft\", graph \""));
        EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
}

TEST(GraphCheckTest, GraphsThatDoNotMatchTheFormatAreRejected) {
    EXPECT_NO_THROW((void)loadDraft(modelWith("flow_field", "level")));
    expectRefused("wrong_shape", "level", "input \"noisy\" has the shape [?,1,199]; expected [B,1,200]");
    expectRefused("wrong_rank", "level", "input \"noisy\" has the shape [?,200]; expected [B,1,200]");
    expectRefused("wrong_batch", "level", "fixed batch of 1");
    expectRefused("wrong_type", "level", "float32");
    expectRefused("wrong_input", "level", "has an input \"wave\"");
    expectRefused("wrong_output", "level", "has no output \"velocity\"");
    expectRefused("flow_field", "level", "has no output \"segment\"", "direct");
    expectRefused("flow_field", "flow_field", "\"level\"");
    expectRefused("not_onnx", "level", "is not an ONNX model");
    expectRefused("average_field", "level", "has an input \"interval\"");
    EXPECT_NO_THROW((void)loadDraft(modelWith("average_field", "level", "average-velocity")));
}

class NotFiniteTest : public ::testing::Test {
protected:
    static std::vector<float> run(const model::ModelFile& model, const std::array<float, 3>& motion) {
        const std::array<float, segmentSamples> previous{};
        std::array<float, segmentSamples> noise{};
        noise.fill(-1.0F);
        const SegmentRequest request{{}, motion, previous, noise};
        std::vector<float> segment(segmentSamples);
        loadDraft(model).generate({&request, 1}, segment);
        return segment;
    }
};

TEST_F(NotFiniteTest, AFieldOrALevelThatIsNotFiniteAndAnImpossiblyHighLevelAreErrors) {
    EXPECT_THROW((void)run(modelWith("not_finite_field", "level"), {0.1F, 0.0F, 1.0F}), InferenceError);
    const model::ModelFile levels = modelWith("flow_field", "not_finite_level");
    // By its speed the graph's level is minus infinity, NaN, and too high.
    for (const float speedMps : {0.0F, -1.0F, 1e9F}) {
        EXPECT_THROW((void)run(levels, {speedMps, 0.0F, 1.0F}), InferenceError) << speedMps;
    }
}

TEST_F(NotFiniteTest, AVeryLowLevelGivesSilenceInsteadOfAnError) {
    const auto segment = run(modelWith("flow_field", "not_finite_level"), {1e-30F, 0.0F, 1.0F});
    EXPECT_THAT(segment, ::testing::Each(::testing::AllOf(::testing::Gt(-1e-7F), ::testing::Lt(1e-7F))));
}

TEST(OnnxRuntimeTest, TheLibraryIsOpenedByPathAndItsVersionIsReported) {
    const auto runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    EXPECT_THAT(runtime->version(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+.*"));
}

TEST(OnnxRuntimeTest, WhatIsNoLibraryOrNotOnnxRuntimeIsRejectedByItsPath) {
    const auto refusalOf = [](const std::string& path) {
        return failureOf<RuntimeUnavailable>([&path] { return Runtime::open(path); });
    };
    EXPECT_THAT(refusalOf("/nowhere/libonnxruntime.so"),
                ::testing::StartsWith("/nowhere/libonnxruntime.so: cannot be loaded"));
    const std::string notALibrary = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";
    EXPECT_THAT(refusalOf(notALibrary), ::testing::StartsWith(notALibrary));
    EXPECT_THAT(refusalOf("libm.so.6"), ::testing::HasSubstr("OrtGetApiBase"));
}

TEST(OnnxRuntimeTest, AVersionWithoutTheRequiredApiIsRejected) {
    const OrtApiBase base{[](std::uint32_t) noexcept -> const OrtApi* { return nullptr; },
                          []() noexcept -> const char* { return "1.2.3"; }};
    EXPECT_THAT(failureOf<RuntimeUnavailable>([&base] { return Runtime::fromApiBase(&base); }),
                ::testing::HasSubstr("1.2.3 is too old: 1.16"));
}

TEST(OnnxRuntimeTest, AnErrorNamesTheOperationAndTheReason) {
    const auto runtime = testRuntime();
    EXPECT_EQ(failureOf<InferenceError>([&runtime] {
                  runtime->check(runtime->api().CreateStatus(ORT_FAIL, "made by the test"), "trying");
                  return 0;
              }),
              "trying: made by the test");
}

}  // namespace
}  // namespace haptoflow::inference::testing
