#include "engine/material_library.hpp"

#include "small_library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

/// Levels like those of a level graph: powers of speed and force with a variation over direction.
double level(double vx, double vy, double newtons, double first) {
    const double speed = std::hypot(vx, vy);
    const double along = std::cos(2.0 * std::atan2(vy, vx));
    return (0.5 + first) * std::pow(speed, 0.7) * std::pow(newtons, 0.4) * std::exp(0.2 * along);
}

class PowerLaw final : public inference::SegmentGenerator {
public:
    void generate(std::span<const inference::SegmentRequest>, std::span<float>) override {}
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        ++calls;
        requestCount += requests.size();
        if (whenAsked) {
            whenAsked();
        }
        for (std::size_t i = 0; i < requests.size(); ++i) {
            const auto& motion = requests[i].motion;
            levelsMps2[i] = static_cast<float>(
                level(motion[0], motion[1], motion[2], static_cast<double>(std::abs(requests[i].embedding[3]))));
        }
    }

    std::size_t calls = 0;
    std::size_t requestCount = 0;
    std::function<void()> whenAsked;
};

/// The small model with `labels` labels that share `embeddings` embeddings.
model::ModelFile modelWithLabels(std::size_t labels, std::size_t embeddings) {
    model::testing::ModelBuilder builder;
    const nlohmann::json first = builder.header["labels"][0];
    for (std::size_t label = 2; label < labels; ++label) {
        nlohmann::json next = first;
        next["name"] = "label " + std::to_string(label);
        next["embedding_row"] = label % embeddings;
        builder.header["labels"].push_back(next);
    }
    std::vector<float> rows(embeddings * model::embeddingSize);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        rows[i] = 0.001F * static_cast<float>(i / model::embeddingSize);
    }
    builder.blobs[0].shape = {static_cast<std::int64_t>(embeddings), model::embeddingSize};
    builder.blobs[0].bytes = model::testing::bytesOf(rows);
    return model::ModelFile::parse(builder.build());
}

/// Number of evaluations of the level graph for a model's levels.
std::size_t levelsAskedFor(std::size_t labels, std::size_t embeddings) {
    PowerLaw graph;
    const OnsetLevels levels(modelWithLabels(labels, embeddings), graph);
    EXPECT_LE(graph.calls, graph.requestCount / 256 + 1) << "all calls except the last are full batches";
    return graph.requestCount;
}

double decibels(double ratio) {
    return std::abs(20.0 * std::log10(ratio));
}

class OnsetLevelsTest : public ::testing::Test {
protected:
    [[nodiscard]] double expected(std::size_t label, double vx, double vy, double newtons) const {
        return level(vx, vy, newtons, static_cast<double>(std::abs(model_.embedding(label)[3])));
    }

    model::ModelFile model_ = testing::smallModel();
    PowerLaw graph_;
    /// The level of a blend at a motion.
    [[nodiscard]] float levelOf(std::initializer_list<testing::LabelWeight> entries,
                                const std::array<float, 3>& motion) const {
        return MaterialLibrary::ReadScope(library_).ingredients(testing::blendOf(entries)).levelMps2(motion);
    }
    MaterialLibrary library_{model_, graph_};
};

TEST_F(OnsetLevelsTest, TheTableIsWithinHalfADecibelOfTheGraph) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int trial = 0; trial < 2000; ++trial) {
        const double speed = 0.01 * std::pow(40.0, share(random));
        const double angle = 2.0 * std::numbers::pi * share(random);
        const double newtons = 0.1 * std::pow(40.0, share(random));
        const double vx = speed * std::cos(angle);
        const double vy = speed * std::sin(angle);
        const float found = levelOf({{.label = 1, .weight = 1.0F}},
                                    {static_cast<float>(vx), static_cast<float>(vy), static_cast<float>(newtons)});
        ASSERT_LT(decibels(static_cast<double>(found) / expected(1, vx, vy, newtons)), 0.5);
    }
}

TEST_F(OnsetLevelsTest, ABlendLiesBetweenItsLabelsInDecibels) {
    const std::array<float, 3> motion{0.1F, 0.0F, 1.0F};
    const float first = levelOf({{.label = 0, .weight = 1.0F}}, motion);
    const float second = levelOf({{.label = 1, .weight = 1.0F}}, motion);
    const float mixed = levelOf({{.label = 0, .weight = 0.25F}, {.label = 1, .weight = 0.25F}}, motion);
    EXPECT_NEAR(mixed, std::sqrt(first * second), 1e-4F);
}

TEST_F(OnsetLevelsTest, BeyondTheRangeAndAtRestTheLevelIsThatOfTheEdge) {
    const auto oak = [this](const std::array<float, 3>& motion) {
        return levelOf({{.label = 0, .weight = 1.0F}}, motion);
    };
    EXPECT_EQ(oak({0.4F, 0.0F, 4.0F}), oak({4.0F, 0.0F, 400.0F}));
    EXPECT_EQ(oak({0.01F, 0.0F, 0.1F}), oak({0.0F, 0.0F, 0.0F}));
}

TEST(OnsetLevelsCostTest, TheGraphIsEvaluatedAt640PointsForEachEmbedding) {
    EXPECT_EQ(levelsAskedFor(2, 2), 2U * 640U);
    EXPECT_EQ(levelsAskedFor(64, 64), 64U * 640U);
    EXPECT_EQ(levelsAskedFor(4096, 4096), 4096U * 640U);
}

TEST(OnsetLevelsCostTest, LabelsWithTheSameEmbeddingNeedNoFurtherEvaluations) {
    EXPECT_EQ(levelsAskedFor(4096, 16), 16U * 640U);
}

TEST(OnsetLevelsCostTest, ACancellationEndsTheTabulationWithinOneBatch) {
    PowerLaw graph;
    const auto cancellation = std::make_shared<inference::Cancellation>();
    graph.whenAsked = [&] {
        if (graph.calls == 3) {
            cancellation->cancel();
        }
    };
    const model::ModelFile model = modelWithLabels(4096, 4096);
    EXPECT_THROW(OnsetLevels(model, graph, {.cancellation = cancellation}), inference::LoadCancelled);
    EXPECT_EQ(graph.calls, 3U);
}

}  // namespace
}  // namespace haptoflow::engine
