#include "engine/tap_pieces.hpp"

#include "model/model_file.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

namespace haptoflow::engine {
namespace {

// Frequency on the hand: 20-30 %. No figure for a decay on the hand is known to us; listeners accept time constants of
// 75 to 140 % as the same (Jarvelainen and Tolonen 2001).
constexpr double noticeableFrequencyRatio = 1.25;
constexpr double noticeableDecayRatio = 1.4;

double ratioOf(float one, float other) {
    return static_cast<double>(std::max(one, other) / std::min(one, other));
}

const TapPiece& pieceNamed(std::string_view label) {
    return *std::ranges::find(tapPieces(), label, &TapPiece::label);
}

// Apart with the damping of the hand left out, not with it.
using Pair = std::pair<std::string_view, std::string_view>;
const std::set<Pair> alike{{"concrete", "stone"},    {"corduroy", "jute"}, {"glass", "wood"},
                           {"jute", "metal mesh"},   {"metal", "stone"},   {"metal mesh", "plastic"},
                           {"metal mesh", "rubber"}, {"paper", "plywood"}};

TEST(TapPiecesTest, AllPairsOfTapsButTheNamedOnesDifferNoticeablyInFrequencyOrDecay) {
    for (const TapPiece& one : tapPieces()) {
        for (const TapPiece& other : tapPieces()) {
            if (one.label >= other.label) {
                continue;
            }
            const auto first = tapOn(one).modes[0];
            const auto second = tapOn(other).modes[0];
            EXPECT_EQ(ratioOf(first.frequencyHz, second.frequencyHz) <= noticeableFrequencyRatio &&
                          ratioOf(first.decayPerSecond, second.decayPerSecond) <= noticeableDecayRatio,
                      alike.contains({one.label, other.label}))
                << one.label << " " << first.frequencyHz << " Hz, " << first.decayPerSecond << "/s; " << other.label
                << " " << second.frequencyHz << " Hz, " << second.decayPerSecond << "/s";
        }
    }
}

TEST(TapPiecesTest, AThickerAStifferAndASmallerPlateSoundHigher) {
    const TapPiece plate = pieceNamed("wood");
    const float before = tapOn(plate).modes[0].frequencyHz;
    for (const auto& [property, factor] :
         {std::pair(&TapPiece::thicknessMetres, 1.5), {&TapPiece::youngPa, 1.5}, {&TapPiece::sideMetres, 0.8}}) {
        TapPiece changed = plate;
        changed.*property *= factor;
        EXPECT_GT(tapOn(changed).modes[0].frequencyHz, before);
    }
}

TEST(TapPiecesTest, AHeavyPlateOfFarLowerFrequencyThanItsContactRingsAtItsOwnMode) {
    // A plate that the pen hardly loads: pi h / L^2 sqrt(E / (12 rho (1 - nu^2))) = 50.4 Hz.
    const TapPiece plate{.label = "plate",
                         .category = "",
                         .youngPa = 70e9,
                         .densityKgPerM3 = 2500.0,
                         .thicknessMetres = 0.01,
                         .sideMetres = 1.0};
    const double expected = 100.0 * std::pow(0.4924, 0.404);
    EXPECT_NEAR(static_cast<double>(tapOn(plate).modes[0].frequencyHz), expected, 1.0);
}

TEST(TapPiecesTest, ALayerVibratesAsThePenOnItsContactWithOneMode) {
    const TapPiece layer{.label = "layer",
                         .category = "",
                         .youngPa = 1e6,
                         .densityKgPerM3 = 300.0,
                         .thicknessMetres = 0.002,
                         .lossFactor = 0.5};
    const double contact = 2.0 * 0.0005 * 1e6 / 0.91;
    const double hz = std::sqrt(contact / 0.015) / (2.0 * 3.14159265);
    const auto modes = tapOn(layer).modes;
    EXPECT_NEAR(static_cast<double>(modes[0].frequencyHz), 100.0 * std::pow(hz / 100.0, 0.404), 0.1);
    EXPECT_NEAR(static_cast<double>(modes[0].decayPerSecond), 60.0 + 0.5 * 3.14159265 * hz, 0.1);
    EXPECT_EQ(modes[1].frequencyHz, 0.0F);
}

TEST(TapPiecesTest, EveryTapLiesInTheBandThatAHandFeels) {
    for (const TapPiece& piece : tapPieces()) {
        const auto modes = tapOn(piece).modes;
        EXPECT_GE(modes[0].frequencyHz, 30.0F) << piece.label;
        EXPECT_LE(modes[0].frequencyHz, 450.0F) << piece.label;
        EXPECT_LE(modes[1].frequencyHz, 500.0F) << piece.label;
        EXPECT_LT(modes[1].gainPerSecond, modes[0].gainPerSecond) << piece.label;
    }
}

TEST(TapPiecesTest, ALabelHasThePieceOfItsNameElseOfItsCategoryAndStiffness) {
    model::Label label;
    label.name = "concrete";
    label.category = "stone";
    label.stiffnessNewtonsPerMetre = 10.0;
    EXPECT_EQ(tapPieceOf(label)->label, "concrete");
    label.name = "my mat";
    label.category = "plastic";
    label.stiffnessNewtonsPerMetre = 350.0;
    EXPECT_EQ(tapPieceOf(label)->label, "rubber");
    label.category = "cheese";
    EXPECT_EQ(tapPieceOf(label), nullptr);
}

TEST(TapPiecesTest, ACategoryOfThePublishedDataSetHasThePiecesOfItsMaterials) {
    const auto pieceOf = [](const char* category, double stiffness) {
        model::Label label;
        label.name = "unheard of";
        label.category = category;
        label.stiffnessNewtonsPerMetre = stiffness;
        return std::string(tapPieceOf(label)->label);
    };
    EXPECT_EQ(pieceOf("polymer", 900.0), "plastic");
    EXPECT_EQ(pieceOf("polymer", 300.0), "rubber");
    EXPECT_EQ(pieceOf("cloth", 250.0), "cotton");
    EXPECT_EQ(pieceOf("biodegradable", 100.0), "fur");
    EXPECT_EQ(pieceOf("biodegradable", 400.0), "leather");
    EXPECT_EQ(pieceOf("composite", 3000.0), "sandpaper");
    EXPECT_EQ(pieceOf("composite", 800.0), "plastic");
}

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
