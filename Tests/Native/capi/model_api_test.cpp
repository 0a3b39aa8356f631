// Loading through the C interface: one tier or all, time limits, cancellation.

#include "inference/rebuilt_model.hpp"
#include "open_engine.hpp"
#include "open_handles.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

haptoflow_status openBytes(const void* bytes, std::size_t count, haptoflow_model** model) {
    const haptoflow_model_options options{sizeof(options), bytes, count, nullptr};
    return haptoflow_model_open(&options, model);
}

TEST(ModelApiTest, AModelOpenedFromBytesDoesNotNeedThemAfterwards) {
    std::string bytes = textOf(tinyModelPath);
    ModelHandle model;
    ASSERT_EQ(openBytes(bytes.data(), bytes.size(), model.out()), HAPTOFLOW_OK) << message();
    std::fill(bytes.begin(), bytes.end(), '\0');
    const char* header = nullptr;
    ASSERT_EQ(haptoflow_model_header(model, &header), HAPTOFLOW_OK);
    EXPECT_EQ(nlohmann::json::parse(header)["name"], "tiny");
    EXPECT_EQ(haptoflow_model_close(model.out()), HAPTOFLOW_OK);
    EXPECT_FALSE(model);
}

TEST(ModelApiTest, EachKindOfInvalidFileHasItsOwnStatus) {
    const std::string valid = textOf(tinyModelPath);
    haptoflow_model* model = nullptr;

    auto changed = valid;
    changed[0] = 'X';
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_NOT_A_MODEL);
    EXPECT_EQ(openBytes(valid.data(), valid.size() - 1, &model), HAPTOFLOW_MODEL_TRUNCATED);
    changed = valid;
    changed[100] = static_cast<char>(changed[100] ^ 1);
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_MODEL_DAMAGED);
    EXPECT_THAT(message(), ::testing::HasSubstr("checksum at byte 24"));
    changed = valid;
    changed.push_back('\0');
    EXPECT_EQ(openBytes(changed.data(), changed.size(), &model), HAPTOFLOW_MODEL_INCONSISTENT);
    EXPECT_EQ(openBytes(valid.data(), std::size_t{1} << 40U, &model), HAPTOFLOW_MODEL_OVERSIZED);
    EXPECT_EQ(model, nullptr);
}

TEST(ModelApiTest, EitherBytesOrAPathMustBeGiven) {
    const std::string bytes = textOf(tinyModelPath);
    haptoflow_model* model = nullptr;
    const haptoflow_model_options both{sizeof(both), bytes.data(), bytes.size(), tinyModelPath.c_str()};
    EXPECT_EQ(haptoflow_model_open(&both, &model), HAPTOFLOW_INVALID_ARGUMENT);
    const haptoflow_model_options neither{sizeof(neither), nullptr, 0, nullptr};
    EXPECT_EQ(haptoflow_model_open(&neither, &model), HAPTOFLOW_INVALID_ARGUMENT);
}

class OpenModelTest : public WithTinyModel {};

TEST_F(OpenModelTest, TheLabelsAreListed) {
    uint32_t count = 0;
    ASSERT_EQ(haptoflow_model_label_count(model_, &count), HAPTOFLOW_OK);
    ASSERT_EQ(count, 2U);
    auto info = sized<haptoflow_label_info>();
    ASSERT_EQ(haptoflow_model_label(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "ruled");
    EXPECT_STREQ(info.category, "test");
    EXPECT_EQ(info.is_periodic, 1U);
    EXPECT_DOUBLE_EQ(info.wavelength_metres, 0.001);
    EXPECT_DOUBLE_EQ(info.stiffness_newtons_per_metre, 600.0);
    EXPECT_DOUBLE_EQ(info.friction_coefficient, 0.3);
    EXPECT_EQ(haptoflow_model_label(model_, 2, &info), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("2 labels"));
}

TEST_F(OpenModelTest, TheEmbeddingOfALabelIsReturned) {
    std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding{};
    ASSERT_EQ(haptoflow_model_embedding(model_, 1, embedding.data()), HAPTOFLOW_OK);
    EXPECT_NEAR(embedding[10], std::sin(2.0), 1e-6);
    EXPECT_EQ(haptoflow_model_embedding(model_, 9, embedding.data()), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST_F(OpenModelTest, TheHeadersTextsAndRangesAreReturned) {
    const char* text = nullptr;
    ASSERT_EQ(haptoflow_model_header(model_, &text), HAPTOFLOW_OK);
    const auto header = nlohmann::json::parse(text);
    auto info = sized<haptoflow_model_info>();
    ASSERT_EQ(haptoflow_model_describe(model_, &info), HAPTOFLOW_OK) << message();
    EXPECT_EQ(header["name"], info.name);
    EXPECT_EQ(header["description"], info.description);
    EXPECT_EQ(header["provenance"]["statement"], info.statement);
    EXPECT_EQ(header["provenance"]["recordings"], info.recordings);
    EXPECT_EQ(header["provenance"]["licence"], info.licence);
    EXPECT_EQ(header["provenance"]["commit"], info.commit);
    EXPECT_EQ(header["provenance"]["created"], info.created);
    EXPECT_EQ(header["range"]["speed_mps"], std::to_array(info.speed_mps));
    EXPECT_EQ(header["range"]["force_newtons"], std::to_array(info.force_newtons));
}

TEST_F(OpenModelTest, EveryLabelIsNearestToItselfWhateverItsWaveVectors) {
    for (uint32_t label = 0; label < 2; ++label) {
        std::array<float, HAPTOFLOW_EMBEDDING_SIZE> embedding{};
        ASSERT_EQ(haptoflow_model_embedding(model_, label, embedding.data()), HAPTOFLOW_OK);
        std::fill(embedding.end() - 4, embedding.end(), 1000.0F);
        uint32_t nearest = 77;
        ASSERT_EQ(haptoflow_model_nearest_label(model_, embedding.data(), &nearest), HAPTOFLOW_OK) << message();
        EXPECT_EQ(nearest, label);
    }
}

TEST_F(OpenModelTest, TheTiersAreListed) {
    uint32_t count = 0;
    ASSERT_EQ(haptoflow_model_tier_count(model_, &count), HAPTOFLOW_OK);
    ASSERT_EQ(count, 5U);
    auto info = sized<haptoflow_tier_info>();
    ASSERT_EQ(haptoflow_model_tier(model_, 0, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "draft");
    EXPECT_STREQ(info.kind, "average-velocity");
    EXPECT_EQ(info.is_default, 0U);
    ASSERT_EQ(haptoflow_model_tier(model_, 2, &info), HAPTOFLOW_OK);
    EXPECT_STREQ(info.name, "fine");
    EXPECT_EQ(info.solver, HAPTOFLOW_SOLVER_HEUN);
    EXPECT_EQ(info.steps, 8);
    EXPECT_EQ(info.parameter_count, 267);
    EXPECT_STREQ(info.cost_json, "{}");
    ASSERT_EQ(haptoflow_model_tier(model_, 1, &info), HAPTOFLOW_OK);
    EXPECT_EQ(info.is_default, 1U);
}

using model::testing::Bytes;
using Graphs = std::map<std::string, Bytes>;

class LoadingApiTest : public WithTinyModel {
protected:
    /// The tiny model with other graphs.
    void openRebuilt(
        const Graphs& graphs, const std::function<void(nlohmann::json&)>& editHeader = [](auto&) {}) {
        EXPECT_EQ(haptoflow_model_close(model_.out()), HAPTOFLOW_OK);
        const Bytes bytes = inference::testing::withGraphs(model::ModelFile::read(tinyModelPath), graphs, editHeader);
        ASSERT_EQ(openBytes(bytes.data(), bytes.size(), model_.out()), HAPTOFLOW_OK) << message();
    }
    [[nodiscard]] haptoflow_engine_options optionsOf(haptoflow_quality quality) const {
        return engineOptions(runtime_, model_, quality, quality == HAPTOFLOW_QUALITY_AUTO);
    }
    static void expectRefused(const haptoflow_engine_options& options, haptoflow_status status,
                              const std::string& part) {
        haptoflow_engine* engine = nullptr;
        EXPECT_EQ(haptoflow_engine_create(&options, &engine), status);
        EXPECT_EQ(engine, nullptr);
        EXPECT_THAT(message(), ::testing::HasSubstr(part));
    }
    static void expectRefused(const haptoflow_generator_options& options, haptoflow_status status,
                              const std::string& part) {
        haptoflow_generator* generator = nullptr;
        EXPECT_EQ(haptoflow_generator_create(&options, &generator), status);
        EXPECT_EQ(generator, nullptr);
        EXPECT_THAT(message(), ::testing::HasSubstr(part));
    }

    CancellationHandle cancellation_;
};

TEST_F(LoadingApiTest, AQualityWithoutATierOfItsNameUsesTheFirstOrTheDefaultTier) {
    const auto keepTiers = [this](const std::vector<std::string>& names) {
        openRebuilt({}, [&](nlohmann::json& header) {
            nlohmann::json tiers = nlohmann::json::array();
            for (std::size_t tier = 0; tier < names.size(); ++tier) {
                tiers.push_back(header["tiers"][tier]);
                tiers[tier]["name"] = names[tier];
            }
            header["tiers"] = tiers;
            header["default_tier"] = names[1];
        });
    };
    const auto tierFor = [this](haptoflow_quality quality) {
        const EngineHandle engine(createEngine(optionsOf(quality)));
        return statisticsOf(engine).tier;
    };
    keepTiers({"draft", "standard"});
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_DRAFT), 0U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_STANDARD), 1U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_SKETCH), 0U);
    keepTiers({"small", "medium", "large"});
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_DRAFT), 0U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_STANDARD), 1U);
    EXPECT_EQ(tierFor(HAPTOFLOW_QUALITY_SKETCH), 0U);
}

TEST_F(LoadingApiTest, AModelWithALoopIsRefusedAtOnceByGeneratorAndEngine) {
    openRebuilt({{"level", model::testing::loopingLevel()}});
    expectRefused(optionsOf(HAPTOFLOW_QUALITY_DRAFT), HAPTOFLOW_MODEL_INCONSISTENT,
                  "tier \"draft\", graph \"level\": uses the operator \"Loop\"");
    expectRefused(generatorOptions(runtime_, model_), HAPTOFLOW_MODEL_INCONSISTENT, "\"Loop\"");
}

TEST_F(LoadingApiTest, ATierThatIsTooSlowIsNamedByGeneratorAndEngine) {
    openRebuilt({{"level", model::testing::slowLevel()}});
    haptoflow_engine_options options = optionsOf(HAPTOFLOW_QUALITY_STANDARD);
    options.probe_limit_ms = 2.0;
    expectRefused(options, HAPTOFLOW_TIER_TOO_SLOW, ", graph \"level\"");
    haptoflow_generator_options ofGenerator = generatorOptions(runtime_, model_, "draft");
    ofGenerator.probe_limit_ms = 2.0;
    expectRefused(ofGenerator, HAPTOFLOW_TIER_TOO_SLOW,
                  "tier \"draft\", graph \"level\": a run of 256 took longer than");
}

TEST_F(LoadingApiTest, AProbeLimitOutOfRangeIsRefused) {
    for (const double limit : {-1.0, 3600000.5, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        haptoflow_engine_options options = optionsOf(HAPTOFLOW_QUALITY_DRAFT);
        options.probe_limit_ms = limit;
        expectRefused(options, HAPTOFLOW_INVALID_ARGUMENT, "probe_limit_ms is");
    }
}

TEST_F(LoadingApiTest, ARunningLoadEndsWhenItIsCancelled) {
    openRebuilt({{"level", model::testing::slowLevel()}});
    ASSERT_EQ(haptoflow_cancellation_create(cancellation_.out()), HAPTOFLOW_OK);
    haptoflow_engine_options options = optionsOf(HAPTOFLOW_QUALITY_AUTO);
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
    ASSERT_EQ(haptoflow_cancellation_create(cancellation_.out()), HAPTOFLOW_OK);
    haptoflow_engine_options options = optionsOf(HAPTOFLOW_QUALITY_DRAFT);
    options.cancellation = cancellation_;
    const EngineHandle engine(createEngine(options));
    ASSERT_EQ(haptoflow_cancellation_cancel(cancellation_), HAPTOFLOW_OK);
    expectRefused(options, HAPTOFLOW_CANCELLED, "cancelled");
    haptoflow_generator_options ofGenerator = generatorOptions(runtime_, model_);
    ofGenerator.cancellation = cancellation_;
    expectRefused(ofGenerator, HAPTOFLOW_CANCELLED, "cancelled");
    EXPECT_EQ(haptoflow_engine_set_quality(engine, HAPTOFLOW_QUALITY_STANDARD), HAPTOFLOW_OK)
        << "the cancellation was for the creation only: " << message();
    EXPECT_EQ(haptoflow_cancellation_cancel(cancellation_), HAPTOFLOW_OK);
}

TEST_F(LoadingApiTest, AClosedCancellationIsRefused) {
    ASSERT_EQ(haptoflow_cancellation_create(cancellation_.out()), HAPTOFLOW_OK);
    haptoflow_cancellation* const closed = cancellation_;
    ASSERT_EQ(haptoflow_cancellation_close(cancellation_.out()), HAPTOFLOW_OK);
    EXPECT_FALSE(cancellation_);
    EXPECT_EQ(haptoflow_cancellation_cancel(closed), HAPTOFLOW_INVALID_ARGUMENT);
    haptoflow_engine_options options = optionsOf(HAPTOFLOW_QUALITY_DRAFT);
    options.cancellation = closed;
    expectRefused(options, HAPTOFLOW_INVALID_ARGUMENT, "cancellation");
}

}  // namespace
}  // namespace haptoflow::capi::testing
