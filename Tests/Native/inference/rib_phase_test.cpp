#include "inference/onnx_segment_generator.hpp"
#include "model/model_error.hpp"
#include "rebuilt_model.hpp"
#include "rib_graph.hpp"
#include "tiny_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <vector>

// Tests of the optional input "phases" of a field graph.

namespace haptoflow::inference::testing {
namespace {

using model::testing::Bytes;

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
            OnnxSegmentGenerator generator(testRuntime(), model, tier, {SolverKind::euler, 2}, maximumBatch);
            const auto effect = effectOfPhase(generator, requests);
            for (std::size_t i = 0; i < effect.size(); ++i) {
                // The decoder of the latent tier halves every second sample.
                const float share = std::string(tier) == "latent" && i % 2 == 1 ? 0.5F : 1.0F;
                ASSERT_NEAR(effect[i], share * weighted(phases[i / segmentSamples]), 2e-5F) << tier << ' ' << i;
            }
        }
    }
}

TEST(RibPhaseInputTest, AGraphWithoutTheInputLoadsAndIgnoresThePhase) {
    const auto requests = requestsWithPhases();
    for (const char* tier : {"draft", "standard", "direct", "latent"}) {
        OnnxSegmentGenerator generator(testRuntime(), tinyModel(), tier, {SolverKind::euler, 2}, 4);
        EXPECT_THAT(effectOfPhase(generator, requests), ::testing::Each(0.0F)) << tier;
    }
}

TEST(RibPhaseInputTest, TheErrorForAnotherShapeNamesTierGraphAndShape) {
    for (const auto& [tier, blob, output] :
         {std::array{"standard", "flow_field", "velocity"}, std::array{"draft", "average_field", "velocity"},
          std::array{"direct", "direct_field", "segment"}}) {
        const auto model = model::ModelFile::parse(withGraphs(tinyModel(), {{blob, ribField(output, {1, 200}, 3)}}));
        try {
            (void)OnnxSegmentGenerator(testRuntime(), model, tier, {SolverKind::euler, 1}, 1);
            ADD_FAILURE() << tier << " was accepted";
        } catch (const model::ModelError& error) {
            EXPECT_EQ(error.status(), model::ModelStatus::inconsistent);
            EXPECT_EQ(std::string(error.what()), std::string("tier \"") + tier + "\", graph \"" + blob +
                                                     "\": input \"phases\" has the shape [?,3]; expected [B,6]");
        }
    }
}

}  // namespace
}  // namespace haptoflow::inference::testing
