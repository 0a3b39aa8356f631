#include "inference/skeleton_generator.hpp"

#include "inference/tier_generator.hpp"
#include "model/model_error.hpp"
#include "rebuilt_model.hpp"
#include "skeleton/condition.hpp"
#include "support/model_generator.hpp"
#include "tiny_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

// Tiers of the kinds `skeleton` and `refine`, against what PyTorch wrote for the same weights.

namespace haptoflow::inference::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double skeletonTolerance = 1e-5;

const model::ModelFile& skeletonModel() {
    static const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
    return model;
}

const model::Tier& tierNamed(const std::string& name) {
    return *skeletonModel().findTier(name);
}

std::unique_ptr<TierGenerator> openTier(const std::string& name, std::size_t maximumBatch = 4) {
    return inference::makeGenerator(name == "sketch" ? nullptr : testRuntime(), skeletonModel(), tierNamed(name), {},
                                    maximumBatch);
}

class SkeletonGeneratorTest : public ::testing::Test {
protected:
    SkeletonGeneratorTest() {
        for (const auto& row : haptoflow::testing::goldenRows(golden_, "cases")) {
            batch_.add(row.at("embedding"), row.at("motion"), row.at("previous"), row.at("noise"));
        }
        requests_ = batch_.requests();
        owns_.resize(requests_.size());
        for (std::size_t row = 0; row < requests_.size(); ++row) {
            requests_[row].phases = golden_.at("cases")[row].at("phases").get<skeleton::Phases>();
            owns_[row] = golden_.at("cases")[row].at("own").get<std::vector<float>>();
            requests_[row].own = owns_[row];
        }
    }

    [[nodiscard]] std::vector<double> expected(std::size_t row, const std::string& key) const {
        return golden_.at("cases")[row].at(key).get<std::vector<double>>();
    }

    std::vector<float> generate(TierGenerator& generator) {
        std::vector<float> segments(requests_.size() * segmentSamples);
        generator.generate(requests_, segments);
        return segments;
    }

    void expectGolden(const std::vector<float>& segments, const std::string& key) {
        for (std::size_t row = 0; row < requests_.size(); ++row) {
            const auto wanted = expected(row, key);
            double squares = 0.0;
            double largest = 0.0;
            for (std::size_t n = 0; n < segmentSamples; ++n) {
                squares += wanted[n] * wanted[n];
                largest =
                    std::max(largest, std::fabs(static_cast<double>(segments[row * segmentSamples + n]) - wanted[n]));
            }
            EXPECT_LE(largest, skeletonTolerance * std::sqrt(squares / segmentSamples)) << key << " of case " << row;
        }
    }

    nlohmann::json golden_ = haptoflow::testing::readGolden("model/skeleton.parity.json");
    RequestBatch batch_;
    std::vector<SegmentRequest> requests_;
    std::vector<std::vector<float>> owns_;
};

TEST_F(SkeletonGeneratorTest, TheSketchAgreesWithPyTorchAndNeedsNoOnnxRuntime) {
    const auto generator = inference::makeGenerator(nullptr, skeletonModel(), tierNamed("sketch"), {}, 4);
    expectGolden(generate(*generator), "sketch_segment");
}

TEST_F(SkeletonGeneratorTest, TheRefinedSegmentAgreesWithPyTorchInBatchesOfEverySize) {
    for (const std::size_t batch : {1U, 3U, 8U}) {
        expectGolden(generate(*openTier("standard", batch)), "standard_segment");
    }
}

TEST_F(SkeletonGeneratorTest, ABatchNeedsOneRunOfTheRefiningGraph) {
    RefinedGenerator generator({countingRuntime(), skeletonModel(), tierNamed("standard"), 4},
                               skeleton::readNativeParts(skeletonModel()));
    const int before = graphRuns;
    (void)generate(generator);
    EXPECT_EQ(graphRuns, before + 2) << "seven requests in batches of four";
    std::vector<float> levels(requests_.size());
    generator.levels(requests_, levels);
    EXPECT_EQ(graphRuns, before + 2) << "levels need no graph";
}

TEST_F(SkeletonGeneratorTest, ASegmentThatAStreamHasMadeTakesThePlaceOfTheSketch) {
    std::vector<skeleton::NetworkInput> made(requests_.size());
    std::vector<SegmentRequest> withStreams = requests_;
    for (std::size_t row = 0; row < requests_.size(); ++row) {
        made[row].values.fill(0.125F);
        withStreams[row].networkInput = &made[row];
    }
    const std::vector<float> refined = generate(*openTier("standard"));
    requests_ = withStreams;
    EXPECT_NE(generate(*openTier("standard")), refined);
    const std::vector<float> segments = generate(*openTier("sketch"));
    for (std::size_t row = 0; row < requests_.size(); ++row) {
        EXPECT_NEAR(segments[row * segmentSamples + 7], 0.125 * std::exp(expected(row, "log_level")[0]), 1e-5) << row;
    }
}

TEST_F(SkeletonGeneratorTest, LevelsAgreeWithPyTorchAndNeedNoOnnxRuntime) {
    for (const std::string tier : {"sketch", "standard"}) {
        const auto estimator = makeLevelEstimator(nullptr, skeletonModel(), tierNamed(tier));
        std::vector<float> levels(requests_.size());
        estimator->levels(requests_, levels);
        for (std::size_t row = 0; row < levels.size(); ++row) {
            EXPECT_NEAR(std::log(static_cast<double>(levels[row])), expected(row, "log_level")[0], skeletonTolerance);
        }
    }
}

TEST_F(SkeletonGeneratorTest, ARequestsOwnLevelMotionAndGainAreUsed) {
    const auto estimator = makeLevelEstimator(nullptr, skeletonModel(), tierNamed("sketch"));
    requests_.erase(requests_.begin() + 3, requests_.end());
    requests_[1] = requests_[0];
    requests_[2] = requests_[0];
    requests_[0].levelMps2 = 0.125F;
    requests_[1].levelMotion = {0.4F, 0.0F, 2.0F};
    requests_[2].motion = {0.4F, 0.0F, 2.0F};
    requests_[2].levelGain = 2.0F;
    std::vector<float> levels(requests_.size());
    estimator->levels(requests_, levels);
    EXPECT_EQ(levels[0], 0.125F);
    EXPECT_FLOAT_EQ(2.0F * levels[1], levels[2]);
    EXPECT_THROW(estimator->levels(requests_, std::span(levels).first(2)), std::invalid_argument);
}

TEST_F(SkeletonGeneratorTest, AnImpossibleLevelIsAnError) {
    const auto generator = openTier("sketch");
    requests_.erase(requests_.begin() + 1, requests_.end());
    requests_[0].embedding.fill(1e6F);
    std::vector<float> segment(segmentSamples);
    std::vector<float> level(1);
    try {
        generator->levels(requests_, level);
        EXPECT_TRUE(std::isfinite(level[0])) << "the weights happen to give a level below 20";
    } catch (const InferenceError& error) {
        EXPECT_THAT(error.what(), HasSubstr("the level model returned a logarithm of"));
    }
    requests_[0].embedding.fill(std::numeric_limits<float>::quiet_NaN());
    EXPECT_THROW(generator->generate(requests_, segment), InferenceError);
}

TEST_F(SkeletonGeneratorTest, ABrokenPastOrNoiseNeitherFailsNorSpreads) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::array<float, segmentSamples> broken{};
    broken.fill(nan);
    broken[3] = std::numeric_limits<float>::infinity();
    for (SegmentRequest& request : requests_) {
        request.previous = broken;
        request.noise = broken;
    }
    for (const std::string tier : {"sketch", "standard"}) {
        const auto segments = generate(*openTier(tier));
        EXPECT_TRUE(std::ranges::all_of(segments, [](float sample) { return std::isfinite(sample); })) << tier;
    }
}

TEST_F(SkeletonGeneratorTest, ARefiningTierWithoutOnnxRuntimeIsRefusedByName) {
    try {
        (void)inference::makeGenerator(nullptr, skeletonModel(), tierNamed("standard"), {}, 4);
        ADD_FAILURE() << "it was loaded";
    } catch (const std::invalid_argument& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("\"standard\" needs ONNX Runtime"), HasSubstr("runtime")));
    }
}

TEST_F(SkeletonGeneratorTest, SettingsOutOfRangeAreRejectedForEveryKind) {
    for (const std::string tier : {"sketch", "standard"}) {
        EXPECT_THROW((void)openTier(tier, 0), std::invalid_argument);
        EXPECT_THROW((void)openTier(tier, maximumBatchSize + 1), std::invalid_argument);
        const auto generator = openTier(tier);
        EXPECT_THROW(generator->setSolver({SolverKind::euler, 17}), std::invalid_argument);
        generator->setSolver({SolverKind::heun, 4});
        std::vector<float> tooShort(segmentSamples);
        EXPECT_THROW(generator->generate(requests_, tooShort), std::invalid_argument);
    }
}

TEST_F(SkeletonGeneratorTest, ALoadCanBeCancelledForEveryKind) {
    const auto cancellation = std::make_shared<Cancellation>();
    cancellation->cancel();
    for (const std::string tier : {"sketch", "standard"}) {
        EXPECT_THROW((void)inference::makeGenerator(testRuntime(), skeletonModel(), tierNamed(tier), {}, 1,
                                                    {.cancellation = cancellation}),
                     LoadCancelled);
    }
}

TEST_F(SkeletonGeneratorTest, AGraphThatTakesAnotherFilmIsRefusedByName) {
    // The conditioning of the tiny model's graph has no film at all, and its output another name.
    const auto tiny = tinyModel().blob("flow_field");
    const auto model = model::ModelFile::parse(
        withGraphs(skeletonModel(), {{"standard.field", model::testing::Bytes(tiny.begin(), tiny.end())}}));
    try {
        (void)inference::makeGenerator(testRuntime(), model, *model.findTier("standard"), {}, 1);
        ADD_FAILURE() << "it was loaded";
    } catch (const model::ModelError& error) {
        EXPECT_THAT(error.what(), HasSubstr("tier \"standard\", graph \"standard.field\""));
    }
}

TEST(RibRatesTest, RatesAreWaveVectorTimesVelocityWithTheirSign) {
    std::array<float, embeddingSize> embedding{};
    embedding[60] = 0.5F;
    embedding[61] = -0.25F;
    embedding[63] = 2.0F;
    const auto found = skeleton::phasesOf(embedding, {0.1F, 0.2F, 1.0F}, {0.25F, 0.75F});
    EXPECT_EQ(found[0], 0.25F);
    EXPECT_EQ(found[1], 0.75F);
    EXPECT_EQ(found[2], 0.0F);
    // .5 cycles/mm * 100 mm/s - .25 * 200.
    EXPECT_NEAR(found[3], 0.0, 1e-4);
    EXPECT_NEAR(found[4], 400.0, 1e-3);
    EXPECT_EQ(found[5], 0.0F);
    EXPECT_NEAR(skeleton::phasesOf(embedding, {-0.1F, 0.0F, 1.0F}, {})[3], -50.0, 1e-4);
}

// Compares the default model in ONNX Runtime with the same weights in Python.

constexpr double tolerance = 1e-4;

class DefaultModelParityTest : public ::testing::Test {
protected:
    void SetUp() override {
        golden_ = haptoflow::testing::readGolden("model/default.parity.json");
        model_.emplace(model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL));
        const auto text = golden_.at("model_crc32").get<std::string>();
        const auto expected = std::strtoul(text.c_str(), nullptr, 16);
        ASSERT_EQ(text.size(), 8U) << "model_crc32 must be eight hexadecimal digits";
        ASSERT_EQ(model_->checksum(), expected)
            << "default.parity.json belongs to another default.haptoflow: run the training's export again";
    }

    template <typename Compare>
    void forEveryCase(Compare compare) {
        for (const auto& row : haptoflow::testing::goldenRows(golden_, "cases")) {
            const auto tier = row.at("tier").get<std::string>();
            SCOPED_TRACE(tier);
            RequestBatch batch;
            batch.add(row.at("embedding"), row.at("motion"), row.at("previous"), row.at("noise"),
                      row.at("phases").get<skeleton::Phases>());
            const auto generator = haptoflow::testing::generatorOf(*model_, 1, tier);
            std::vector<SegmentRequest> requests = batch.requests();
            const auto own = row.value("own", std::vector<float>{});
            requests.front().own = own;
            compare(row, requests, *generator);
        }
    }

    static double largestDifference(const std::vector<float>& found, const std::vector<double>& expected,
                                    double scale) {
        EXPECT_EQ(found.size(), expected.size());
        double largest = 0.0;
        for (std::size_t index = 0; index < std::min(found.size(), expected.size()); ++index) {
            largest = std::max(largest, std::fabs(static_cast<double>(found[index]) - expected[index]) / scale);
        }
        return largest;
    }

    nlohmann::json golden_;
    std::optional<model::ModelFile> model_;
};

TEST_F(DefaultModelParityTest, LevelsAgreeWithPython) {
    forEveryCase([](const auto& row, const auto& requests, TierGenerator& generator) {
        std::vector<float> level(1);
        generator.levels(requests, level);
        EXPECT_NEAR(std::log(static_cast<double>(level[0])), row.at("log_level").template get<double>(), tolerance);
    });
}

TEST_F(DefaultModelParityTest, SegmentsAgreeWithPython) {
    forEveryCase([](const auto& row, const auto& requests, TierGenerator& generator) {
        std::vector<float> segment(segmentSamples);
        generator.generate(requests, segment);
        const double level = std::exp(row.at("log_level").template get<double>());
        EXPECT_LE(largestDifference(segment, row.at("segment"), level), tolerance);
    });
}

TEST_F(DefaultModelParityTest, EveryTierHasACase) {
    for (const model::Tier& tier : model_->header().tiers) {
        const auto& rows = haptoflow::testing::goldenRows(golden_, "cases");
        EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), [&](const auto& row) { return row.at("tier") == tier.name; }))
            << tier.name;
    }
}

}  // namespace
}  // namespace haptoflow::inference::testing
