// Loading through the C interface: one tier or all, time limits, cancellation, the log.
#include "open_engine.hpp"

#include "inference/rebuilt_model.hpp"

#include <array>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using model::testing::Bytes;
using Graphs = std::map<std::string, Bytes>;

constexpr uint32_t draftTier = 0;
constexpr uint32_t standardTier = 1;

class LoadingApiTest : public ::testing::Test {
protected:
    void TearDown() override {
        for (haptoflow_engine* engine : engines_) {
            EXPECT_EQ(haptoflow_engine_close(&engine), HAPTOFLOW_OK);
        }
        EXPECT_EQ(haptoflow_cancellation_close(&cancellation_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_runtime_close(&runtime_), HAPTOFLOW_OK);
    }

    /// The tiny model with other graphs.
    void openModel(
        const Graphs& graphs, const std::function<void(nlohmann::json&)>& editHeader = [](auto&) {}) {
        EXPECT_EQ(haptoflow_model_close(&model_), HAPTOFLOW_OK);
        const Bytes bytes = inference::testing::withGraphs(model::ModelFile::read(tinyModelPath), graphs, editHeader);
        const haptoflow_model_options options{sizeof(options), bytes.data(), bytes.size(), nullptr};
        ASSERT_EQ(haptoflow_model_open(&options, &model_), HAPTOFLOW_OK) << message();
    }
    [[nodiscard]] haptoflow_engine_options engineOptions(haptoflow_quality quality) const {
        haptoflow_engine_options options{};
        options.struct_size = sizeof(options);
        options.quality = quality;
        options.runtime = runtime_;
        options.model = model_;
        options.without_worker = quality == HAPTOFLOW_QUALITY_AUTO ? 0 : 1;
        options.fixed_lead_ms = 8.0;
        return options;
    }
    haptoflow_engine* open(const haptoflow_engine_options& options) {
        haptoflow_engine* engine = nullptr;
        EXPECT_EQ(haptoflow_engine_create(&options, &engine), HAPTOFLOW_OK) << message();
        engines_.push_back(engine);
        return engine;
    }
    static void expectRefused(const haptoflow_engine_options& options, haptoflow_status status,
                              const std::string& part) {
        haptoflow_engine* engine = nullptr;
        EXPECT_EQ(haptoflow_engine_create(&options, &engine), status);
        EXPECT_EQ(engine, nullptr);
        EXPECT_THAT(message(), ::testing::HasSubstr(part));
    }
    static uint32_t tierOf(const haptoflow_engine* engine) {
        haptoflow_engine_statistics statistics{};
        statistics.struct_size = sizeof(statistics);
        EXPECT_EQ(haptoflow_engine_get_statistics(engine, &statistics), HAPTOFLOW_OK);
        return statistics.tier;
    }
    static uint64_t runsOf(const haptoflow_engine* engine, uint32_t tier) {
        haptoflow_tier_times times{};
        times.struct_size = sizeof(times);
        EXPECT_EQ(haptoflow_engine_tier_times(engine, tier, &times), HAPTOFLOW_OK);
        return times.runs;
    }
    /// Publishes and generates one touch with one segment.
    static void slide(haptoflow_engine* engine, haptoflow_voice voice, uint32_t touch) {
        haptoflow_contact_state state = slidingState();
        state.touch_counter = touch;
        std::vector<float> block(667);
        EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_voice_render(voice, block.data(), 667, 1, 0, 48000.0), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_engine_step(engine), HAPTOFLOW_OK);
    }

    haptoflow_runtime* runtime_ = openRuntime();
    haptoflow_model* model_ = openTinyModel();
    haptoflow_cancellation* cancellation_ = nullptr;
    std::vector<haptoflow_engine*> engines_;
};

TEST_F(LoadingApiTest, AQualityWithoutATierOfItsNameUsesTheFirstOrTheDefaultTier) {
    const auto keepTiers = [this](const std::vector<std::string>& names) {
        openModel({}, [&](nlohmann::json& header) {
            nlohmann::json tiers = nlohmann::json::array();
            for (std::size_t tier = 0; tier < names.size(); ++tier) {
                tiers.push_back(header["tiers"][tier]);
                tiers[tier]["name"] = names[tier];
            }
            header["tiers"] = tiers;
            header["default_tier"] = names[1];
        });
    };
    const auto tierFor = [this](haptoflow_quality quality) { return tierOf(open(engineOptions(quality))); };
    keepTiers({"draft", "standard"});
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_DRAFT), 0U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_STANDARD), 1U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_SKETCH), 0U);
    keepTiers({"small", "medium", "large"});
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_DRAFT), 0U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_STANDARD), 1U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_SKETCH), 0U);
}

TEST_F(LoadingApiTest, AutomaticQualityUsesTheMostAccurateTierByItsFiguresAndNotTheLast) {
    openModel({}, [](nlohmann::json& header) {
        header["tiers"].erase(3);
        header["tiers"].erase(3);
        const std::array<double, 3> errorsDb{2.0, 1.0, 3.0};
        for (std::size_t tier = 0; tier < errorsDb.size(); ++tier) {
            header["tiers"][tier]["accuracy"] = {{"lsd_db", errorsDb[tier]}, {"level_error_p90_db", 0.5}};
        }
        header["default_tier"] = "draft";
    });
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_AUTO);
    options.without_worker = 0;
    options.fixed_lead_ms = 0.0;
    // A budget of 40 ms for graphs that take microseconds.
    options.update_rate_hz = 25.0;
    options.budget_share = 1.0;
    haptoflow_engine* engine = open(options);
    haptoflow_engine_statistics statistics{};
    do {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        statistics.struct_size = sizeof(statistics);
        ASSERT_EQ(haptoflow_engine_get_statistics(engine, &statistics), HAPTOFLOW_OK);
    } while (statistics.is_measuring != 0);
    EXPECT_EQ(statistics.tier, standardTier);
}

TEST_F(LoadingApiTest, AModelWithALoopIsRefusedAtOnceByGeneratorAndEngine) {
    openModel({{"level", model::testing::loopingLevel()}});
    expectRefused(engineOptions(HAPTOFLOW_QUALITY_DRAFT), HAPTOFLOW_MODEL_INCONSISTENT,
                  "tier \"draft\", graph \"level\": uses the operator \"Loop\"");
    haptoflow_generator_options options{};
    options.struct_size = sizeof(options);
    options.runtime = runtime_;
    options.model = model_;
    haptoflow_generator* generator = nullptr;
    EXPECT_EQ(haptoflow_generator_create(&options, &generator), HAPTOFLOW_MODEL_INCONSISTENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("\"Loop\""));
}

TEST_F(LoadingApiTest, ATierThatIsTooSlowIsNamedByGeneratorAndEngine) {
    openModel({{"level", model::testing::slowLevel()}});
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_STANDARD);
    options.probe_limit_ms = 2.0;
    expectRefused(options, HAPTOFLOW_TIER_TOO_SLOW, "tier \"standard\", graph \"level\"");
    haptoflow_generator_options generatorOptions{};
    generatorOptions.struct_size = sizeof(generatorOptions);
    generatorOptions.runtime = runtime_;
    generatorOptions.model = model_;
    generatorOptions.tier = "draft";
    generatorOptions.probe_limit_ms = 2.0;
    haptoflow_generator* generator = nullptr;
    EXPECT_EQ(haptoflow_generator_create(&generatorOptions, &generator), HAPTOFLOW_TIER_TOO_SLOW);
    EXPECT_EQ(generator, nullptr);
    EXPECT_THAT(message(), ::testing::HasSubstr("tier \"draft\", graph \"level\": a run of 256 took longer than"));
}

TEST_F(LoadingApiTest, AProbeLimitOutOfRangeIsRefused) {
    for (const double limit : {-1.0, 3600000.5, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_DRAFT);
        options.probe_limit_ms = limit;
        expectRefused(options, HAPTOFLOW_INVALID_ARGUMENT, "probe_limit_ms is");
    }
}

TEST_F(LoadingApiTest, ARunningLoadEndsWhenItIsCancelled) {
    openModel({{"level", model::testing::slowLevel()}});
    ASSERT_EQ(haptoflow_cancellation_create(&cancellation_), HAPTOFLOW_OK);
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_AUTO);
    options.cancellation = cancellation_;
    options.probe_limit_ms = 3600000.0;
    std::thread canceller([this] {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_EQ(haptoflow_cancellation_cancel(cancellation_), HAPTOFLOW_OK);
    });
    expectRefused(options, HAPTOFLOW_CANCELLED, "the load was cancelled");
    canceller.join();
}

TEST_F(LoadingApiTest, ACancellationAlsoEndsLaterLoads) {
    ASSERT_EQ(haptoflow_cancellation_create(&cancellation_), HAPTOFLOW_OK);
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_DRAFT);
    options.cancellation = cancellation_;
    haptoflow_engine* engine = open(options);
    ASSERT_EQ(haptoflow_cancellation_cancel(cancellation_), HAPTOFLOW_OK);
    expectRefused(options, HAPTOFLOW_CANCELLED, "cancelled");
    haptoflow_generator_options generatorOptions{};
    generatorOptions.struct_size = sizeof(generatorOptions);
    generatorOptions.runtime = runtime_;
    generatorOptions.model = model_;
    generatorOptions.cancellation = cancellation_;
    haptoflow_generator* generator = nullptr;
    EXPECT_EQ(haptoflow_generator_create(&generatorOptions, &generator), HAPTOFLOW_CANCELLED);
    EXPECT_EQ(haptoflow_engine_set_quality(engine, HAPTOFLOW_QUALITY_STANDARD), HAPTOFLOW_OK)
        << "the cancellation was for the creation only: " << message();
    EXPECT_EQ(haptoflow_cancellation_cancel(cancellation_), HAPTOFLOW_OK);
}

TEST_F(LoadingApiTest, AClosedCancellationIsRefused) {
    ASSERT_EQ(haptoflow_cancellation_create(&cancellation_), HAPTOFLOW_OK);
    haptoflow_cancellation* const closed = cancellation_;
    ASSERT_EQ(haptoflow_cancellation_close(&cancellation_), HAPTOFLOW_OK);
    EXPECT_EQ(cancellation_, nullptr);
    EXPECT_EQ(haptoflow_cancellation_cancel(closed), HAPTOFLOW_INVALID_ARGUMENT);
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_DRAFT);
    options.cancellation = closed;
    expectRefused(options, HAPTOFLOW_INVALID_ARGUMENT, "cancellation");
}

struct LogLines {
    static void write(void* context, int32_t severity, const char* text) {
        auto& lines = *static_cast<LogLines*>(context);
        const std::lock_guard lock(lines.mutex);
        lines.severities.push_back(severity);
        lines.texts.emplace_back(text);
    }
    std::mutex mutex;
    std::vector<int32_t> severities;
    std::vector<std::string> texts;
};

TEST_F(LoadingApiTest, MessagesOfOnnxRuntimeReachTheLogUntilTheRuntimeIsClosed) {
    model::testing::OnnxWriter failing = model::testing::levelGraph();
    failing.constant(model::testing::integerTensor("size", {60'000, 60'000}))
        .apply("ConstantOfShape", {"size"}, {"zeros"})
        .apply("ReduceSum", {"zeros"}, {"nothing"}, {model::testing::integerAttribute("keepdims", 0)})
        .apply("Add", {"weighted", "nothing"}, {"log_level"});
    LogLines lines;
    haptoflow_runtime* logged = nullptr;
    const haptoflow_runtime_options runtimeOptions{sizeof(runtimeOptions), nullptr, HAPTOFLOW_TEST_ONNXRUNTIME,
                                                   LogLines::write, &lines};
    ASSERT_EQ(haptoflow_runtime_open(&runtimeOptions, &logged), HAPTOFLOW_OK) << message();
    haptoflow_engine_options options = engineOptions(HAPTOFLOW_QUALITY_DRAFT);
    options.runtime = logged;
    haptoflow_engine* engine = open(options);

    openModel({{"level", failing.model().written()}});
    options.model = model_;
    expectRefused(options, HAPTOFLOW_MODEL_INCONSISTENT, "tier \"draft\", graph \"level\"");
    EXPECT_THAT(lines.texts, ::testing::Contains(::testing::HasSubstr("ConstantOfShape")));
    EXPECT_THAT(lines.severities, ::testing::Each(::testing::AllOf(::testing::Ge(HAPTOFLOW_LOG_WARNING),
                                                                   ::testing::Le(HAPTOFLOW_LOG_FATAL))));
    ASSERT_EQ(haptoflow_runtime_close(&logged), HAPTOFLOW_OK);
    const std::size_t before = lines.texts.size();
    EXPECT_EQ(haptoflow_engine_set_quality(engine, HAPTOFLOW_QUALITY_STANDARD), HAPTOFLOW_OK) << message();
    EXPECT_EQ(lines.texts.size(), before);
}

}  // namespace
}  // namespace haptoflow::capi::testing
