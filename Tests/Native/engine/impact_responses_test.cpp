
#include "engine/tap_pieces.hpp"
#include "model/model_file.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace haptoflow::engine {
namespace {

model::Label labelOf(double stiffness) {
    model::Label label;
    label.stiffnessNewtonsPerMetre = stiffness;
    return label;
}

TEST(ImpactResponsesTest, WithoutModelDataStifferLabelsHaveHigherFrequencies) {
    float before = 0.0F;
    for (const double stiffness : {100.0, 350.0, 1200.0, 4000.0}) {
        const effects::ImpactResponse response = impactResponse(labelOf(stiffness));
        EXPECT_GT(response.modes[0].frequencyHz, before) << stiffness;
        EXPECT_GT(response.modes[0].gainPerSecond, 0.0F);
        EXPECT_EQ(response.modes[1].frequencyHz, 0.0F);
        before = response.modes[0].frequencyHz;
    }
    EXPECT_FLOAT_EQ(impactResponse(labelOf(1e-3)).modes[0].frequencyHz, 25.0F);
    EXPECT_FLOAT_EQ(impactResponse(labelOf(1e6)).modes[0].frequencyHz, 450.0F);
}

TEST(ImpactResponsesTest, TheModelsImpactResponseIsUsed) {
    model::Label label = labelOf(800.0);
    label.impact = model::Impact{.modes = {{{90.0, 70.0, 110.0}, {}}}, .restitution = 0.1};
    const effects::ImpactResponse response = impactResponse(label);
    EXPECT_FLOAT_EQ(response.modes[0].frequencyHz, 90.0F);
    EXPECT_FLOAT_EQ(response.modes[0].decayPerSecond, 70.0F);
    EXPECT_FLOAT_EQ(response.modes[0].gainPerSecond, 110.0F);
    EXPECT_FLOAT_EQ(response.restitution, 0.1F);
}

TEST(ImpactResponsesTest, ALabelWhoseHeaderOnlyRepeatsItsStiffnessHasTheTapOfItsPiece) {
    model::Label label = labelOf(5000.0);
    label.name = "metal";
    label.impact = model::Impact{.modes = {{{353.55, 70.65, 333.22}, {340.0, 178.0, 100.0}}}, .restitution = 0.28};
    const effects::ImpactResponse response = impactResponse(label);
    EXPECT_EQ(response.modes[0].frequencyHz, tapOn(*tapPieceOf(label)).modes[0].frequencyHz);
    EXPECT_FLOAT_EQ(response.restitution, 0.28F);
    label.impact->modes[0].frequencyHz = 350.0;
    EXPECT_FLOAT_EQ(impactResponse(label).modes[0].frequencyHz, 350.0F) << "a mode of the file's own is kept";
}

TEST(ImpactResponsesTest, EveryLabelOfTheShippedModelHasTheTapOfAPieceOfItsName) {
    const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    for (const model::Label& label : model.header().labels) {
        const TapPiece* piece = tapPieceOf(label);
        ASSERT_NE(piece, nullptr) << label.name;
        EXPECT_EQ(piece->label, label.name);
        EXPECT_EQ(piece->category, label.category);
        EXPECT_EQ(piece->stiffnessNewtonsPerMetre, label.stiffnessNewtonsPerMetre) << label.name;
        EXPECT_EQ(impactResponse(label).modes[0].frequencyHz, tapOn(*piece).modes[0].frequencyHz) << label.name;
    }
}

TEST(ImpactResponsesTest, ABlendOfTwoPiecesLiesBetweenTheirTaps) {
    model::testing::ModelBuilder builder;
    builder.header["labels"][0]["category"] = "glass";
    builder.header["labels"][1]["category"] = "fur";
    const testing::SmallLibrary small(model::ModelFile::parse(builder.build()));
    const auto tap = [&small](std::initializer_list<testing::LabelWeight> entries) {
        return impactResponse(small.ingredients(entries)).modes[0];
    };
    const auto glass = tap({{0, 1.0F}});
    const auto fur = tap({{1, 1.0F}});
    const auto both = tap({{0, 0.5F}, {1, 0.5F}});
    EXPECT_NEAR(both.frequencyHz, std::sqrt(glass.frequencyHz * fur.frequencyHz), 0.01F);
    EXPECT_NEAR(both.gainPerSecond, 0.5F * (glass.gainPerSecond + fur.gainPerSecond), 0.01F);
}

}  // namespace
}  // namespace haptoflow::engine
