#include "../model/model_builder.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "tiny_model.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

// Models whose graphs do not match the format. The graphs are blobs of tiny.haptoflow that no tier uses.

namespace haptoflow::inference::testing {
namespace {

using model::testing::Bytes;
using model::testing::ModelBuilder;

model::ModelFile modelWith(const std::string& fieldBlob, const std::string& levelBlob,
                           const std::string& kind = "flow") {
    ModelBuilder builder;
    for (auto& blob : builder.blobs) {
        if (blob.name == "field" || blob.name == "level") {
            const auto graph = tinyModel().blob(blob.name == "field" ? fieldBlob : levelBlob);
            blob.bytes = Bytes(graph.begin(), graph.end());
        }
    }
    builder.header["tiers"][0]["kind"] = kind;
    return model::ModelFile::parse(builder.build());
}

OnnxSegmentGenerator makeGenerator(const model::ModelFile& model) {
    return {testRuntime(), model, "draft", {SolverKind::euler, 1}, 4};
}

void expectRefused(const std::string& fieldBlob, const std::string& levelBlob, const std::string& part,
                   const std::string& kind = "flow") {
    try {
        (void)makeGenerator(modelWith(fieldBlob, levelBlob, kind));
        ADD_FAILURE() << fieldBlob << " and " << levelBlob << " were accepted";
    } catch (const model::ModelError& error) {
        EXPECT_EQ(error.status(), model::ModelStatus::inconsistent);
        EXPECT_THAT(error.what(), ::testing::StartsWith("tier \"draft\", graph \""));
        EXPECT_THAT(error.what(), ::testing::HasSubstr(part));
    }
}

TEST(GraphCheckTest, MatchingGraphsAreAccepted) {
    EXPECT_NO_THROW((void)makeGenerator(modelWith("flow_field", "level")));
}

TEST(GraphCheckTest, GraphsThatDoNotMatchTheFormatAreRejected) {
    expectRefused("wrong_shape", "level", "input \"noisy\" has the shape [?,1,199]; expected [B,1,200]");
    expectRefused("wrong_rank", "level", "input \"noisy\" has the shape [?,200]; expected [B,1,200]");
    expectRefused("wrong_batch", "level", "fixed batch of 1");
    expectRefused("wrong_type", "level", "float32");
    expectRefused("wrong_input", "level", "has an input \"wave\"");
    expectRefused("wrong_output", "level", "has no output \"velocity\"");
    expectRefused("flow_field", "level", "has no output \"segment\"", "direct");
    expectRefused("flow_field", "flow_field", "\"level\"");
    expectRefused("not_onnx", "level", "is not an ONNX model");
}

TEST(GraphCheckTest, AnIntervalInputInAFlowTierIsRejected) {
    expectRefused("average_field", "level", "has an input \"interval\"");
    EXPECT_NO_THROW((void)makeGenerator(modelWith("average_field", "level", "average-velocity")));
}

class NotFiniteTest : public ::testing::Test {
protected:
    static std::vector<float> run(const model::ModelFile& model, const std::array<float, 3>& motion) {
        const std::array<float, segmentSamples> previous{};
        std::array<float, segmentSamples> noise{};
        noise.fill(-1.0F);
        const SegmentRequest request{{}, motion, previous, noise};
        std::vector<float> segment(segmentSamples);
        makeGenerator(model).generate({&request, 1}, segment);
        return segment;
    }
};

TEST_F(NotFiniteTest, AFieldThatReturnsNaNIsAnError) {
    EXPECT_THROW((void)run(modelWith("not_finite_field", "level"), {0.1F, 0.0F, 1.0F}), InferenceError);
}

TEST_F(NotFiniteTest, ALevelOfMinusInfinityIsAnError) {
    EXPECT_THROW((void)run(modelWith("flow_field", "not_finite_level"), {0.0F, 0.0F, 1.0F}), InferenceError);
}

TEST_F(NotFiniteTest, ALevelOfNaNIsAnError) {
    EXPECT_THROW((void)run(modelWith("flow_field", "not_finite_level"), {-1.0F, 0.0F, 1.0F}), InferenceError);
}

TEST_F(NotFiniteTest, AnImpossiblyHighLevelIsAnError) {
    EXPECT_THROW((void)run(modelWith("flow_field", "not_finite_level"), {1e9F, 0.0F, 1.0F}), InferenceError);
}

TEST_F(NotFiniteTest, AVeryLowLevelGivesSilenceInsteadOfAnError) {
    const auto segment = run(modelWith("flow_field", "not_finite_level"), {1e-30F, 0.0F, 1.0F});
    EXPECT_THAT(segment, ::testing::Each(::testing::AllOf(::testing::Gt(-1e-7F), ::testing::Lt(1e-7F))));
}

}  // namespace
}  // namespace haptoflow::inference::testing
