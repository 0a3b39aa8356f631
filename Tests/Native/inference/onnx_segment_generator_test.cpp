#include "inference/onnx_segment_generator.hpp"

#include "inference/graph_session.hpp"
#include "inference/tier_generator.hpp"
#include "model/model_error.hpp"
#include "rebuilt_model.hpp"
#include "rib_graph.hpp"
#include "tiny_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::inference::testing {
namespace {

OnnxSegmentGenerator makeGenerator(const std::string& tier, SolverSettings solver, std::size_t maximumBatch = 4) {
    return openNetwork(tinyModel(), tier, solver, maximumBatch, {}, nullptr, countingRuntime());
}

/// How many graphs the action runs.
template <typename Action>
int runsOf(Action action) {
    const int before = graphRuns;
    action();
    return graphRuns - before;
}

std::vector<float> generate(OnnxSegmentGenerator& generator, std::span<const SegmentRequest> requests) {
    std::vector<float> segments(requests.size() * segmentSamples);
    generator.generate(requests, segments);
    return segments;
}

/// The largest difference, relative to the segment's level.
double unitScaleDifference(const std::vector<float>& left, const std::vector<float>& right,
                           const std::vector<float>& levelsMps2) {
    EXPECT_EQ(left.size(), right.size());
    double largest = 0.0;
    for (std::size_t index = 0; index < left.size(); ++index) {
        const double difference = std::fabs(static_cast<double>(left[index]) - static_cast<double>(right[index]));
        largest = std::max(largest, difference / static_cast<double>(levelsMps2.at(index / segmentSamples)));
    }
    return largest;
}

TEST(OnnxSegmentGeneratorTest, AgreesWithNumpyForEverySolverStepAndTier) {
    const nlohmann::json golden = haptoflow::testing::readGolden("model/tiny.expected.json");
    const auto requests = goldenBatch().requests();
    for (const auto& row : haptoflow::testing::goldenRows(golden, "cases")) {
        const auto tier = row.at("tier").get<std::string>();
        const SolverSettings solver{solverNamed(row.at("solver")), row.at("steps").get<int>()};
        SCOPED_TRACE(tier + ' ' + row.at("solver").get<std::string>() + ' ' + std::to_string(solver.steps));
        std::vector<float> expected;
        for (const auto& segment : row.at("segments_mps2")) {
            const auto values = segment.get<std::vector<float>>();
            expected.insert(expected.end(), values.begin(), values.end());
        }
        ASSERT_EQ(expected.size(), requests.size() * segmentSamples);
        const auto levels = row.at("levels_mps2").get<std::vector<float>>();
        OnnxSegmentGenerator generator = makeGenerator(tier, solver);
        EXPECT_LE(unitScaleDifference(generate(generator, requests), expected, levels), 1e-5);
    }
}

TEST(OnnxSegmentGeneratorTest, LevelsAgreeWithNumpyAndNeedNoFieldRun) {
    const nlohmann::json golden = haptoflow::testing::readGolden("model/tiny.expected.json");
    const auto expected = golden.at("cases").at(0).at("levels_mps2").get<std::vector<float>>();
    const auto requests = goldenBatch().requests();
    ASSERT_EQ(expected.size(), requests.size());
    OnnxSegmentGenerator generator = makeGenerator("standard", {});
    std::vector<float> levels(requests.size());
    EXPECT_EQ(runsOf([&] { generator.levels(requests, levels); }), 1);
    for (std::size_t index = 0; index < levels.size(); ++index) {
        EXPECT_NEAR(levels[index] / expected[index], 1.0F, 1e-5F);
    }
}

TEST(OnnxSegmentGeneratorTest, ABatchNeedsOneRunOfTheLevelAndOnePerEvaluation) {
    const auto requests = goldenBatch().requests();
    struct Case {
        const char* tier;
        SolverSettings solver;
        int runs;
    };
    for (const auto& [tier, solver, runs] :
         {Case{"standard", {SolverKind::heun, 8}, 1 + 16}, Case{"direct", {SolverKind::heun, 16}, 1 + 1},
          // With one run of the encoder and one of the decoder.
          Case{"latent", {SolverKind::euler, 4}, 1 + 1 + 4 + 1}}) {
        OnnxSegmentGenerator generator = makeGenerator(tier, solver);
        EXPECT_EQ(runsOf([&] { (void)generate(generator, requests); }), runs) << tier;
    }
}

TEST(OnnxSegmentGeneratorTest, RequestsBeyondTheMaximumBatchAreSplit) {
    const auto requests = goldenBatch().requests();
    OnnxSegmentGenerator whole = makeGenerator("standard", {SolverKind::midpoint, 2}, 3);
    OnnxSegmentGenerator parts = makeGenerator("standard", {SolverKind::midpoint, 2}, 2);
    const auto expected = generate(whole, requests);
    std::vector<float> found;
    EXPECT_EQ(runsOf([&] { found = generate(parts, requests); }), 2 * (1 + 4));
    EXPECT_LE(unitScaleDifference(found, expected, {1.0F, 1.0F, 1.0F}), 1e-5);
}

TEST(OnnxSegmentGeneratorTest, ARequestGivesTheSameSegmentAloneAndInABatch) {
    const auto requests = goldenBatch().requests();
    OnnxSegmentGenerator generator = makeGenerator("latent", {SolverKind::midpoint, 2});
    const auto together = generate(generator, requests);
    for (std::size_t index = 0; index < requests.size(); ++index) {
        const auto alone = generate(generator, std::span(requests).subspan(index, 1));
        for (std::size_t sample = 0; sample < segmentSamples; ++sample) {
            EXPECT_NEAR(alone[sample], together[index * segmentSamples + sample], 1e-4F);
        }
    }
    EXPECT_EQ(generate(generator, requests), together);
}

TEST(OnnxSegmentGeneratorTest, AnAverageVelocityTierAlwaysUsesEuler) {
    const auto requests = goldenBatch().requests();
    OnnxSegmentGenerator heun = makeGenerator("draft", {SolverKind::heun, 3});
    OnnxSegmentGenerator plain = makeGenerator("draft", {SolverKind::euler, 3});
    const auto expected = generate(plain, requests);
    EXPECT_EQ(runsOf([&] { EXPECT_EQ(generate(heun, requests), expected); }), 1 + 3);
}

TEST(OnnxSegmentGeneratorTest, NonFiniteNoiseIsAnErrorThatDoesNotAffectTheNextBatch) {
    auto requests = goldenBatch().requests();
    OnnxSegmentGenerator generator = makeGenerator("standard", {SolverKind::midpoint, 2});
    const auto expected = generate(generator, requests);
    std::array<float, segmentSamples> broken{};
    broken[17] = std::numeric_limits<float>::quiet_NaN();
    auto brokenRequests = requests;
    brokenRequests[1].noise = broken;
    std::vector<float> segments(expected.size());
    EXPECT_THROW(generator.generate(brokenRequests, segments), InferenceError);
    EXPECT_EQ(generate(generator, requests), expected);
}

TEST(OnnxSegmentGeneratorTest, SettingsOutOfRangeAreRejected) {
    EXPECT_THROW((void)makeGenerator("standard", {SolverKind::euler, 0}), std::invalid_argument);
    EXPECT_THROW((void)makeGenerator("standard", {SolverKind::euler, 17}), std::invalid_argument);
    const model::Tier& tier = *tinyModel().findTier("standard");
    for (const std::size_t batch : {0U, 257U}) {
        EXPECT_THROW((void)inference::makeGenerator(testRuntime(), tinyModel(), tier, {}, batch),
                     std::invalid_argument);
    }
    OnnxSegmentGenerator generator = makeGenerator("standard", {});
    EXPECT_THROW(generator.setSolver({SolverKind::euler, 17}), std::invalid_argument);
    EXPECT_EQ(runsOf([&] { (void)generate(generator, goldenBatch().requests()); }), 1 + 4) << "those before";
}

TEST(OnnxSegmentGeneratorTest, OutputSpansOfTheWrongSizeAreRejected) {
    const auto requests = goldenBatch().requests();
    OnnxSegmentGenerator generator = makeGenerator("standard", {});
    std::vector<float> room(requests.size() * segmentSamples - 1);
    EXPECT_THROW(generator.generate(requests, room), std::invalid_argument);
    EXPECT_THROW(generator.levels(requests, room), std::invalid_argument);
}

TEST(SharedSessionsTest, TiersOfOneGraphLoadItOnceAndDoNotDisturbEachOther) {
    const auto requests = goldenBatch().requests();
    const std::span<const SegmentRequest> one = std::span(requests).first(1);
    OnnxSegmentGenerator alone = makeGenerator("fine", {SolverKind::heun, 5});
    const std::vector<float> expected = generate(alone, requests);

    SharedSessions sessions;
    OnnxSegmentGenerator fine = openNetwork(tinyModel(), "fine", {SolverKind::heun, 5}, 4, {}, &sessions);
    OnnxSegmentGenerator standard = openNetwork(tinyModel(), "standard", {SolverKind::euler, 1}, 4, {}, &sessions);
    EXPECT_EQ(sessions.loaded(), 1U) << "both have flow_field";
    (void)generate(standard, one);
    EXPECT_EQ(generate(fine, requests), expected);

    const OnnxSegmentGenerator latent = openNetwork(tinyModel(), "latent", {}, 4, {}, &sessions);
    EXPECT_EQ(sessions.loaded(), 4U) << "field, encoder and decoder";
    const OnnxSegmentGenerator same = openNetwork(tinyModel(), "latent", {SolverKind::heun, 2}, 4, {}, &sessions);
    EXPECT_EQ(sessions.loaded(), 4U);
    const OnnxSegmentGenerator larger = openNetwork(tinyModel(), "latent", {}, 5, {}, &sessions);
    EXPECT_EQ(sessions.loaded(), 7U) << "another batch has other buffers";
}

// Tests of the optional input "phases" of a field graph.

constexpr std::array<std::array<float, 2>, 3> phases{{{0.25F, 0.5F}, {0.9F, 0.0F}, {0.0F, 0.75F}}};

/// The tiny model with fields that output their rib phase.
model::ModelFile ribModel() {
    return model::ModelFile::parse(withGraphs(tinyModel(), {{"flow_field", ribField("velocity", {1, 200})},
                                                            {"average_field", ribField("velocity", {1, 200})},
                                                            {"direct_field", ribField("segment", {1, 200})},
                                                            {"latent_field", ribField("velocity", {4, 25})}}));
}

std::vector<SegmentRequest> requestsWithPhases() {
    auto requests = goldenBatch().requests();
    for (std::size_t i = 0; i < requests.size(); ++i) {
        std::ranges::copy(phases[i], requests[i].phases.begin());
    }
    return requests;
}

/// The difference, in unit scale, between the tier's segments with and without the phases.
std::vector<float> effectOfPhase(OnnxSegmentGenerator& generator, const std::vector<SegmentRequest>& requests) {
    auto without = requests;
    for (SegmentRequest& request : without) {
        request.phases = {};
    }
    std::vector<float> levels(requests.size());
    std::vector<float> with(requests.size() * segmentSamples);
    std::vector<float> plain(with.size());
    generator.levels(requests, levels);
    generator.generate(requests, with);
    generator.generate(without, plain);
    for (std::size_t i = 0; i < with.size(); ++i) {
        with[i] = (with[i] - plain[i]) / levels[i / segmentSamples];
    }
    return with;
}

float weighted(const std::array<float, 2>& phase) {
    return firstRibWeight * phase[0] + secondRibWeight * phase[1];
}

TEST(RibPhaseInputTest, EveryKindOfTierReceivesThePhaseOfEachRequest) {
    const model::ModelFile model = ribModel();
    const auto requests = requestsWithPhases();
    for (const char* tier : {"draft", "standard", "direct", "latent"}) {
        for (const std::size_t maximumBatch : {4U, 2U, 1U}) {
            OnnxSegmentGenerator generator = openNetwork(model, tier, {SolverKind::euler, 2}, maximumBatch);
            const auto effect = effectOfPhase(generator, requests);
            for (std::size_t i = 0; i < effect.size(); ++i) {
                // The decoder of the latent tier halves every second sample.
                const float share = std::string(tier) == "latent" && i % 2 == 1 ? 0.5F : 1.0F;
                ASSERT_NEAR(effect[i], share * weighted(phases[i / segmentSamples]), 2e-5F) << tier << ' ' << i;
            }
        }
    }
}

/// u = -x, so that x(1) = x(0) / e.
void decay(std::span<const float> point, float /*time*/, float /*interval*/, std::span<float> velocity) {
    std::ranges::transform(point, velocity.begin(), [](float value) { return -value; });
}

float decayed(SolverSettings settings, float start) {
    std::array<float, 1> point{start};
    Solver().integrate(decay, settings, point);
    return point[0];
}

/// The order of convergence: the binary logarithm of the error's reduction when the step is halved.
double convergenceOrder(SolverKind kind) {
    const auto error = [kind](int steps) {
        return std::fabs(static_cast<double>(decayed({kind, steps}, 1.0F)) - std::exp(-1.0));
    };
    return std::log2(error(8) / error(16));
}

TEST(SolverTest, EachKindConvergesWithItsPowerOfTheStepByItsFormula) {
    EXPECT_NEAR(convergenceOrder(SolverKind::euler), 1.0, 0.1);
    EXPECT_NEAR(convergenceOrder(SolverKind::midpoint), 2.0, 0.1);
    EXPECT_NEAR(convergenceOrder(SolverKind::heun), 2.0, 0.1);
    EXPECT_FLOAT_EQ(decayed({SolverKind::euler, 1}, 2.0F), 0.0F);
    EXPECT_FLOAT_EQ(decayed({SolverKind::midpoint, 1}, 2.0F), 1.0F);
    EXPECT_FLOAT_EQ(decayed({SolverKind::heun, 1}, 2.0F), 1.0F);
}

TEST(SolverTest, ASolverAcceptsPointsOfDifferentSizesAndOneToSixteenSteps) {
    Solver solver;
    for (const std::size_t size : {1U, 600U, 200U}) {
        std::vector<float> point(size, 1.0F);
        solver.integrate(decay, {SolverKind::midpoint, 1}, point);
        EXPECT_THAT(point, ::testing::Each(0.5F));
    }
    for (const int steps : {-1, 0, 17}) {
        EXPECT_THROW((void)decayed({SolverKind::euler, steps}, 1.0F), std::invalid_argument);
    }
}

}  // namespace
}  // namespace haptoflow::inference::testing
