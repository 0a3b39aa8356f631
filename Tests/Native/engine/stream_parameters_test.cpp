#include "engine/stream_parameters.hpp"

#include "model/model_file.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <optional>

namespace haptoflow::engine {
namespace {

constexpr double samplesPerSecond = inference::waveformRateHz;

skeleton::SurfacePath pathAt(double metres, double speedMps) {
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
    // Waves within a plane cross a path with half of their mean square slope; lengths within half an octave add 12 %.
    const double change = 2.0 * std::numbers::pi * 0.001 / wavelengthMetres;
    EXPECT_NEAR(std::sqrt(slopes) / change, std::sqrt(0.5 * 1.12), 0.2);
}

TEST(SurfaceWanderTest, TheStatedChangeIsThatFromOneSampleToTheNext) {
    for (const double metres : {-1.7, 0.0, 0.42}) {
        skeleton::SurfacePath path = pathAt(metres, 0.02);
        const WanderPoint here = surfaceWander(3, 0.004, path);
        path.startMetres[0] += path.stepMetres[0];
        EXPECT_NEAR(surfaceWander(3, 0.004, path).value - here.value, here.changePerSample, 1e-3);
    }
}

TEST(SurfaceWanderTest, OtherKeysHaveOtherFieldsAndTheSamePlaceTheSameValue) {
    double product = 0.0;
    constexpr int places = 10'000;
    for (int place = 0; place < places; ++place) {
        const skeleton::SurfacePath path = pathAt(0.005 * place, 0.1);
        product += surfaceWander(1, 0.004, path).value * surfaceWander(2, 0.004, path).value / places;
    }
    EXPECT_NEAR(product, 0.0, 0.1);
    EXPECT_EQ(surfaceWander(1, 0.004, pathAt(0.2, 0.1)).value, surfaceWander(1, 0.004, pathAt(0.2, -0.3)).value);
}

TEST(SlipsTest, AHarderPressMakesSlipsRarerAndAFingerTouchCountsAsTheLightest) {
    const model::StickSlip slip{.lengthMetres = 0.001, .wander = 0.25, .wanderMetres = 0.004};
    EXPECT_NEAR(slipsHz(slip, {0.03F, -0.04F, 1.0F}, 0.0), 50.0, 1e-4);
    EXPECT_NEAR(slipsHz(slip, {0.05F, 0.0F, 2.0F}, 0.0), 50.0 * std::pow(2.0, -0.4), 1e-4);
    EXPECT_NEAR(slipsHz(slip, {0.05F, 0.0F, 1.0F}, 2.0), 50.0 * std::exp(-0.5), 1e-4);
    EXPECT_EQ(slipsHz(slip, {0.05F, 0.0F, 0.0F}, 0.0), slipsHz(slip, {0.05F, 0.0F, 0.04F}, 0.0));
    EXPECT_EQ(slipsHz(slip, {0.0F, 0.0F, 1.0F}, 0.0), 0.0);
    EXPECT_EQ(slipsHz({}, {0.05F, 0.0F, 1.0F}, 0.0), 0.0);
}

TEST(SamplesSincePublishedTest, TheOutputsDelayIsAddedAndNoMoreThanAQuarterOfASecondIsGuessed) {
    EXPECT_NEAR(samplesSincePublished(0.0, 1.0, 0.0), 3.0, 1e-9);
    EXPECT_NEAR(samplesSincePublished(10.0, 1.0, 0.01), 33.0, 1e-9);
    EXPECT_NEAR(samplesSincePublished(10.0, 2.0, 0.01), 53.0, 1e-9);
    EXPECT_NEAR(samplesSincePublished(10.0, 2.0, 5.0), 1000.0, 1e-9);
    EXPECT_EQ(samplesSincePublished(0.0, 1.0, -1.0), 0.0);
}

/// A tip on a surface whose first axis is z and whose second is x.
PublishedContact contactAt(const std::array<float, 3>& placeMetres, const std::array<float, 2>& velocityMps) {
    PublishedContact contact;
    contact.touch = 1;
    contact.state = {.touching = 1,
                     .velocityMps = velocityMps,
                     .hasPlace = 1,
                     .surfaceSeed = 5,
                     .placeMetres = placeMetres,
                     .firstAxis = {0.0F, 0.0F, 1.0F},
                     .secondAxis = {1.0F, 0.0F, 0.0F}};
    contact.ranged.motion = {velocityMps[0], velocityMps[1], 1.0F};
    return contact;
}

PublishedContact contactWithoutPlace(const std::array<float, 2>& velocityMps, std::uint64_t touch = 1) {
    PublishedContact contact = contactAt({}, velocityMps);
    contact.state.hasPlace = 0;
    contact.touch = touch;
    return contact;
}

class StreamParametersTest : public ::testing::Test {
protected:
    [[nodiscard]] StreamParameterMaker makerOf(std::uint64_t seed, std::uint32_t voice) const {
        return {skeleton::readNativeParts(library_.model), seed, voice};
    }
    skeleton::StreamParameters madeBy(StreamParameterMaker maker, const PublishedContact& contact) {
        return maker.make(contact, material_, library_.ingredients(smooth_), 0.0, {});
    }
    skeleton::StreamParameters made(const PublishedContact& contact, const MaterialBlend& blend,
                                    double renderedSeconds = 0.0) {
        const Ingredients ingredients = library_.ingredients(blend);
        material_.embedding = resolveMaterial(ingredients).embedding;
        if (evenRibs_) {
            setWaveVectors(material_.embedding, *evenRibs_);
        }
        return maker_.make(contact, material_, ingredients, renderedSeconds, {0.25, 0.5});
    }

    skeleton::StreamParameters made(const PublishedContact& contact) { return made(contact, ruled_); }

    /// Labels of the model: one that slips, and one whose first ribs wander.
    MaterialBlend smooth_ = testing::blendOf({{0, 1.0F}});
    MaterialBlend ruled_ = testing::blendOf({{1, 1.0F}});

    testing::SmallLibrary library_{
        model::ModelFile::read(std::filesystem::path(HAPTOFLOW_TEST_GOLDEN_DIR) / "model" / "skeleton.haptoflow")};
    MaterialInputs material_;
    /// Replace the label's own.
    std::optional<WaveVectors> evenRibs_;
    StreamParameterMaker maker_ = makerOf(1, 0);
};

TEST_F(StreamParametersTest, EvenRibsHaveTheTurnsOfTheirPlaceAndSignedRatesAndNothingSlips) {
    evenRibs_ = {skeleton::WaveVector{0.5F, 0.0F}, skeleton::WaveVector{0.0F, 0.8F}};
    const skeleton::StreamParameters placed = made(contactAt({-0.001F, 0.2F, 0.0025F}, {0.1F, -0.05F}));
    EXPECT_EQ(placed.ribs, *evenRibs_);
    EXPECT_NEAR(placed.families[0].phase.cycles, 1.25, 1e-6);
    EXPECT_NEAR(placed.families[1].phase.cycles, -0.8, 1e-6);
    EXPECT_NEAR(placed.families[0].phase.rateHz, 50.0, 1e-3);
    EXPECT_NEAR(placed.families[1].phase.rateHz, -40.0, 1e-3);
    EXPECT_EQ(placed.families[2].phase.rateHz, 0.0);
    EXPECT_TRUE(placed.families[0].isPlaced && placed.families[1].isPlaced && !placed.families[2].isPlaced);
    const skeleton::StreamParameters unplaced = made(contactWithoutPlace({0.1F, -0.05F}));
    EXPECT_EQ(unplaced.families[0].phase.cycles, 0.25) << "as its seed begins";
    EXPECT_EQ(unplaced.families[1].phase.cycles, 0.5);
    EXPECT_FALSE(unplaced.families[0].isPlaced || unplaced.families[1].isPlaced);
}

TEST_F(StreamParametersTest, ALabelBringsItsOwnWanderAndSlips) {
    constexpr int places = 4000;
    double displaced = 0.0;
    double lengthened = 0.0;
    for (int place = 0; place < places; ++place) {
        const PublishedContact contact = contactAt({0.0F, 0.0F, 0.003F * static_cast<float>(place)}, {0.1F, 0.0F});
        const skeleton::StreamParameters ribs = made(contact, ruled_);
        ASSERT_EQ(ribs.families[2].phase.rateHz, 0.0);
        const double even = static_cast<double>(ribs.ribs[0].x) * 1000.0 * ribs.path.startMetres[2];
        displaced += std::pow(ribs.families[0].phase.cycles - even, 2) / places;
        const skeleton::StreamParameters slips = made(contact, smooth_);
        lengthened += std::pow(std::log(0.1 / 0.0011 / slips.families[2].phase.rateHz), 2) / places;
    }
    EXPECT_NEAR(std::sqrt(displaced), 0.12, 0.012);
    EXPECT_NEAR(std::sqrt(lengthened), 0.25, 0.025);
}

TEST_F(StreamParametersTest, ABlendSlipsAsItsMaterialThatSlipsAndItsRibsWanderAsTheirOwnMaterialsDo) {
    const PublishedContact contact = contactAt({0.0F, 0.0F, 0.1F}, {0.1F, 0.0F});
    const skeleton::StreamParameters blend = made(contact, testing::blendOf({{0, 0.2F}, {1, 0.8F}}));
    EXPECT_EQ(blend.families[0].phase.cycles, made(contact, ruled_).families[0].phase.cycles);
    EXPECT_EQ(blend.families[0].phase.rateHz, made(contact, ruled_).families[0].phase.rateHz);
    EXPECT_EQ(blend.families[2].phase.rateHz, made(contact, smooth_).families[2].phase.rateHz);
}

TEST_F(StreamParametersTest, WanderingRibsAreDisplacedByTheSameAmountAtTheSamePlaceBothWays) {
    const auto firstRibs = [this](float metres, float speedMps) {
        return made(contactAt({0.0F, 0.0F, metres}, {speedMps, 0.0F})).families[0].phase;
    };
    const skeleton::FamilyPhase there = firstRibs(0.1F, 0.1F);
    const skeleton::FamilyPhase back = firstRibs(0.1F, -0.1F);
    EXPECT_EQ(there.cycles, back.cycles);
    EXPECT_NEAR(there.rateHz, -back.rateHz, 1e-6);
    // A sample further, by its rate and by its place.
    EXPECT_NEAR(firstRibs(0.1F + 0.1F / 2000.0F, 0.1F).cycles - there.cycles, there.rateHz / samplesPerSecond, 1e-4);
}

TEST_F(StreamParametersTest, RibsOnACurvedSurfaceAreAddedUpUntilItHasBeenFlatForFiveMillimetres) {
    // A cylinder of 50 mm radius, then the plane that touches it.
    std::uint32_t onset = 1;
    const auto ribsArePlaced = [this, &onset](float angle, float metresBeyond) {
        PublishedContact contact = contactAt({0.0F, 0.05F * std::cos(angle) - metresBeyond * std::sin(angle),
                                              0.05F * std::sin(angle) + metresBeyond * std::cos(angle)},
                                             {0.1F, 0.0F});
        contact.state.firstAxis = {0.0F, -std::sin(angle), std::cos(angle)};
        contact.onset = onset;
        return made(contact).families[0].isPlaced;
    };
    EXPECT_TRUE(ribsArePlaced(0.0F, 0.0F));
    for (float angle = 0.02F; angle < 1.0F; angle += 0.02F) {
        EXPECT_FALSE(ribsArePlaced(angle, 0.0F)) << angle;
    }
    // Slowly, the axes turn by less than a milliradian from one state to the next.
    for (float angle = 1.0F; angle < 1.3F; angle += 0.0007F) {
        EXPECT_FALSE(ribsArePlaced(angle, 0.0F)) << angle;
    }
    EXPECT_FALSE(ribsArePlaced(1.3F, 0.0F));
    EXPECT_FALSE(ribsArePlaced(1.3F, 0.004F));
    EXPECT_TRUE(ribsArePlaced(1.3F, 0.006F));
    EXPECT_FALSE(ribsArePlaced(1.2F, 0.0F));
    ++onset;
    EXPECT_TRUE(ribsArePlaced(1.0F, 0.0F)) << "a new onset knows nothing of the surface";
}

TEST_F(StreamParametersTest, RibsBeyondTheTrainedSpeedAreAddedUp) {
    PublishedContact contact = contactAt({}, {0.8F, 0.0F});
    contact.ranged.motion = {0.4F, 0.0F, 1.0F};
    EXPECT_FALSE(made(contact).families[0].isPlaced);
    contact.state.spatialScale = 2.0F;
    EXPECT_TRUE(made(contact).families[0].isPlaced);
    contact.ranged.readingRate = 1.1;
    EXPECT_FALSE(made(contact).families[0].isPlaced);
}

TEST_F(StreamParametersTest, SurfacesAndEnginesWithOtherSeedsHaveOtherFieldsAndVoicesShareThem) {
    const PublishedContact contact = contactAt({}, {0.1F, 0.0F});
    PublishedContact other = contact;
    other.state.surfaceSeed = 6;
    const std::uint64_t surface = madeBy(makerOf(1, 0), contact).surface;
    EXPECT_NE(surface, madeBy(makerOf(1, 0), other).surface);
    EXPECT_NE(surface, madeBy(makerOf(2, 0), contact).surface);
    EXPECT_EQ(surface, madeBy(makerOf(1, 3), contact).surface);
    const std::uint64_t unplaced = madeBy(makerOf(1, 0), contactWithoutPlace({0.1F, 0.0F})).surface;
    EXPECT_NE(unplaced, madeBy(makerOf(1, 1), contactWithoutPlace({0.1F, 0.0F})).surface);
    EXPECT_NE(unplaced, madeBy(makerOf(1, 0), contactWithoutPlace({0.1F, 0.0F}, 2)).surface);
}

TEST_F(StreamParametersTest, APathBeginsAtThePlaceInTheMaterialsScaleAndItsStepIsTheWayOfASample) {
    PublishedContact contact = contactAt({0.1F, 0.2F, 0.3F}, {0.2F, -0.1F});
    contact.state.spatialScale = 2.0F;
    contact.ranged.readingRate = 1.25;
    const skeleton::StreamParameters parameters = made(contact);
    EXPECT_TRUE(parameters.isPlaced);
    const std::array<double, 3> start{0.05, 0.1, 0.15};
    const std::array<double, 3> step{-0.05 / 2500.0, 0.0, 0.1 / 2500.0};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(parameters.path.startMetres[axis], start[axis], 1e-8);
        EXPECT_NEAR(parameters.path.stepMetres[axis], step[axis], 1e-11);
    }
}

TEST_F(StreamParametersTest, WithoutAPlaceTheVelocityIsAddedUpWithinATouch) {
    const auto startAfter = [this](double seconds, const PublishedContact& contact) {
        return made(contact, smooth_, seconds).path.startMetres;
    };
    const std::array<double, 3> first = startAfter(0.1, contactWithoutPlace({0.1F, 0.05F}));
    const std::array<double, 3> second = startAfter(0.11, contactWithoutPlace({-0.2F, 0.0F}));
    EXPECT_NEAR(second[0] - first[0], 0.001, 1e-8);
    EXPECT_NEAR(second[1] - first[1], 0.0005, 1e-8);
    EXPECT_NEAR(startAfter(0.13, contactWithoutPlace({}))[0] - second[0], -0.004, 1e-8);
    EXPECT_EQ(startAfter(0.2, contactWithoutPlace({}, 2)), first);
}

TEST_F(StreamParametersTest, TheLevelIsTheMaterialsTheModelsOrTheContactsWithoutASkeleton) {
    PublishedContact contact = contactAt({}, {0.1F, 0.0F});
    contact.levelMps2 = 0.3F;
    const float models = made(contact).levelMps2;
    material_.level.gain = 2.0F;
    EXPECT_FLOAT_EQ(made(contact).levelMps2, 2.0F * models);
    material_.level.levelMps2 = 0.7F;
    EXPECT_EQ(made(contact).levelMps2, 0.7F);
    EXPECT_EQ(madeBy({{}, 1, 0}, contact).levelMps2, 0.3F);
}

TEST_F(StreamParametersTest, EveryNumberIsFiniteWhateverThePlace) {
    const auto isFinite = [](double number) { return std::isfinite(number); };
    for (int step = 0; step < 2'000; ++step) {
        const auto place = static_cast<float>(1e4 * std::sin(step));
        const auto speed = static_cast<float>(20.0 * std::cos(0.7 * step));
        PublishedContact contact = contactAt({place, -place, place}, {speed, 20.0F - speed});
        contact.ranged.motion[2] = 5.0F * std::abs(speed);
        contact.state.spatialScale = step % 2 == 0 ? 0.25F : 4.0F;
        const skeleton::StreamParameters parameters = made(contact, step % 3 == 0 ? smooth_ : ruled_, 0.01 * step);
        EXPECT_TRUE(std::isfinite(parameters.levelMps2));
        for (const skeleton::PlacedFamily& family : parameters.families) {
            EXPECT_TRUE(std::isfinite(family.phase.cycles) && std::isfinite(family.phase.rateHz));
        }
        EXPECT_TRUE(std::ranges::all_of(parameters.path.startMetres, isFinite));
        EXPECT_TRUE(std::ranges::all_of(parameters.path.stepMetres, isFinite));
        EXPECT_TRUE(std::ranges::all_of(parameters.skeleton.impulseGains, isFinite));
    }
}

}  // namespace
}  // namespace haptoflow::engine
