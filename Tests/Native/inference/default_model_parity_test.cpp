#include "support/model_generator.hpp"
#include "tiny_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

// Compares the default model in ONNX Runtime with the same weights in Python.

namespace haptoflow::inference::testing {
namespace {

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
            compare(row, batch.requests(), *generator);
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
