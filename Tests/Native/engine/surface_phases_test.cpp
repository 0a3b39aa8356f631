#include "engine/surface_phases.hpp"

#include "model/model_file.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <vector>

namespace haptoflow::engine {
namespace {

constexpr double samplesPerSecond = inference::waveformRateHz;

inference::SurfacePath pathAt(double metres, double speedMps) {
    return {.startMetres = {metres, 0.3, -0.2}, .stepMetres = {speedMps / samplesPerSecond, 0.0, 0.0}};
}

TEST(SurfaceWanderTest, AFieldHasAnRmsOfOneAndChangesOverItsWavelength) {
    constexpr double wavelengthMetres = 0.01;
    double power = 0.0;
    double slopes = 0.0;
    constexpr int places = 40'000;
    for (int place = 0; place < places; ++place) {
        const WanderPoint point = surfaceWander(7, wavelengthMetres, pathAt(0.003 * place, 2.0));
        power += point.value * point.value / places;
        slopes += point.changePerSample * point.changePerSample / places;
    }
    EXPECT_NEAR(power, 1.0, 0.1);
    // Waves within a plane cross a path with half of their mean square slope; lengths spread by half an octave add 12
    // %.
    const double change = 2.0 * std::numbers::pi * 0.001 / wavelengthMetres;
    EXPECT_NEAR(std::sqrt(slopes) / change, std::sqrt(0.5 * 1.12), 0.2);
}

TEST(SurfaceWanderTest, TheStatedChangeIsThatFromOneSampleToTheNext) {
    for (const double metres : {-1.7, 0.0, 0.42}) {
        inference::SurfacePath path = pathAt(metres, 0.02);
        const WanderPoint here = surfaceWander(3, 0.004, path);
        path.startMetres[0] += path.stepMetres[0];
        EXPECT_NEAR(surfaceWander(3, 0.004, path).value - here.value, here.changePerSample, 1e-3);
    }
}

TEST(SurfaceWanderTest, OtherKeysHaveOtherFieldsAndTheSamePlaceTheSameValue) {
    double product = 0.0;
    constexpr int places = 10'000;
    for (int place = 0; place < places; ++place) {
        const inference::SurfacePath path = pathAt(0.005 * place, 0.1);
        product += surfaceWander(1, 0.004, path).value * surfaceWander(2, 0.004, path).value / places;
    }
    EXPECT_NEAR(product, 0.0, 0.1);
    EXPECT_EQ(surfaceWander(1, 0.004, pathAt(0.2, 0.1)).value, surfaceWander(1, 0.004, pathAt(0.2, -0.3)).value);
}

class SurfacePhasesTest : public ::testing::Test {
protected:
    static std::array<float, inference::embeddingSize> ruled() {
        std::array<float, inference::embeddingSize> embedding{};
        setWaveVectors(embedding, {WaveVector{0.5F, 0.0F}, WaveVector{0.0F, 0.8F}});
        return embedding;
    }
    skeleton::Phases at(std::int64_t start, const std::array<float, 3>& motion) {
        SurfaceStretch stretch{.surface = 11, .path = pathAt(metres_, static_cast<double>(motion[0]))};
        return phases_.at(start, embedding_, motion, statistics_, stretch);
    }

    std::array<float, inference::embeddingSize> embedding_ = ruled();
    WaveStatistics statistics_{};
    SurfacePhases phases_;
    double metres_ = 0.1;
};

TEST_F(SurfacePhasesTest, EvenRibsHaveTheirTurnsAndSignedRatesAndNothingSlips) {
    phases_.begin(0, {.phase = {0.25, 0.5}, .cyclesPerSample = {}, .vectors = waveVectorsOf(embedding_)});
    const skeleton::Phases phases = at(0, {0.1F, -0.05F, 1.0F});
    EXPECT_NEAR(phases[0], 0.25F, 1e-6F);
    EXPECT_NEAR(phases[1], 0.5F, 1e-6F);
    EXPECT_NEAR(phases[3], 50.0F, 1e-3F);
    EXPECT_NEAR(phases[4], -40.0F, 1e-3F);
    EXPECT_EQ(phases[2], 0.0F);
    EXPECT_EQ(phases[5], 0.0F);
}

TEST_F(SurfacePhasesTest, ThePhasesOfASegmentSentGoOnAtItsRates) {
    statistics_.slip = {.lengthMetres = 0.001, .wander = 0.0, .wanderMetres = 0.004};
    phases_.begin(0, {});
    (void)at(0, {0.1F, 0.0F, 1.0F});
    phases_.add();
    const skeleton::Phases later = at(30, {0.3F, 0.0F, 1.0F});
    EXPECT_NEAR(later[0], 0.75F, 1e-4F);
    // 100 slips a second for 15 ms.
    EXPECT_NEAR(later[2], 0.5F, 1e-4F);
    EXPECT_NEAR(later[5], 300.0F, 1e-2F);
}

TEST_F(SurfacePhasesTest, ASegmentThatWasNotSentLeavesThePhasesAlone) {
    statistics_.slip = {.lengthMetres = 0.001, .wander = 0.25, .wanderMetres = 0.004};
    phases_.begin(0, {});
    (void)at(0, {0.1F, 0.0F, 1.0F});
    phases_.add();
    const skeleton::Phases expected = at(40, {0.1F, 0.0F, 1.0F});
    (void)at(20, {0.9F, 0.4F, 3.0F});
    EXPECT_EQ(at(40, {0.1F, 0.0F, 1.0F}), expected);
}

TEST_F(SurfacePhasesTest, AHarderPressMakesSlipsRarerAndAFingerTouchCountsAsTheLightest) {
    statistics_.slip = {.lengthMetres = 0.001, .wander = 0.0, .wanderMetres = 0.004};
    phases_.begin(0, {});
    const float light = at(0, {0.1F, 0.0F, 1.0F})[5];
    EXPECT_NEAR(at(0, {0.1F, 0.0F, 2.0F})[5] / light, std::pow(2.0F, -0.4F), 1e-4F);
    EXPECT_EQ(at(0, {0.1F, 0.0F, 0.0F})[5], at(0, {0.1F, 0.0F, 0.04F})[5]);
    EXPECT_EQ(at(0, {0.0F, 0.0F, 1.0F})[5], 0.0F);
}

TEST_F(SurfacePhasesTest, WanderingRibsAreDisplacedByTheSameAmountAtTheSamePlace) {
    statistics_.ribs[0] = {.cycles = 0.12, .wavelengthMetres = 0.014};
    phases_.begin(0, {});
    const skeleton::Phases there = at(0, {0.1F, 0.0F, 1.0F});
    metres_ = 0.137;
    const skeleton::Phases elsewhere = at(0, {0.1F, 0.0F, 1.0F});
    metres_ = 0.1;
    const skeleton::Phases back = at(0, {-0.1F, 0.0F, 1.0F});
    EXPECT_NE(there[0], elsewhere[0]);
    EXPECT_EQ(there[0], back[0]);
    EXPECT_NE(there[3], 50.0F);
    EXPECT_NEAR(there[3], -back[3], 1e-3F);
    EXPECT_EQ(there[1], 0.0F);
}

TEST_F(SurfacePhasesTest, EveryPhaseIsBelowOneAndEveryNumberFiniteWhateverThePlace) {
    statistics_.ribs = {model::RibWander{0.5, 1e-4}, model::RibWander{0.5, 10.0}};
    statistics_.slip = {.lengthMetres = 1e-5, .wander = 3.0, .wanderMetres = 1e-4};
    phases_.begin(0, {});
    for (int step = 0; step < 2'000; ++step) {
        metres_ = 1e4 * std::sin(step);
        const auto speed = static_cast<float>(std::cos(0.7 * step));
        const skeleton::Phases phases = at(7 * step, {speed, 1.0F - speed, 5.0F * std::abs(speed)});
        phases_.add();
        for (std::size_t family = 0; family < skeleton::familyCount; ++family) {
            EXPECT_GE(phases[family], 0.0F);
            EXPECT_LT(phases[family], 1.0F);
            EXPECT_TRUE(std::isfinite(phases[skeleton::familyCount + family]));
        }
    }
}

class WaveStatisticsTest : public ::testing::Test {
protected:
    // Labels: "smooth", which slips, and "ruled", whose ribs wander.
    testing::SmallLibrary library_{
        model::ModelFile::read(std::filesystem::path(HAPTOFLOW_TEST_GOLDEN_DIR) / "model" / "skeleton.haptoflow")};
};

TEST_F(WaveStatisticsTest, ALabelBringsItsOwnWanderAndSlips) {
    const Ingredients smooth = library_.ingredients({{0, 1.0F}});
    EXPECT_NEAR(waveStatisticsOf(smooth, assignRibs(smooth, {})).slip.lengthMetres, 0.0011, 1e-9);
    const Ingredients ruled = library_.ingredients({{1, 1.0F}});
    const WaveStatistics statistics = waveStatisticsOf(ruled, assignRibs(ruled, {}));
    EXPECT_EQ(statistics.slip.lengthMetres, 0.0);
    EXPECT_NEAR(statistics.ribs[0].cycles, 0.12, 1e-9);
    EXPECT_EQ(statistics.ribs[1].cycles, 0.0);
}

}  // namespace
}  // namespace haptoflow::engine
