#include "engine/place_track.hpp"

#include "engine/rib_phase.hpp"
#include "inference/surface_noise.hpp"
#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace haptoflow::engine {
namespace {

PublishedContact contactAt(std::array<float, 3> placeMetres, std::array<float, 2> velocityMps) {
    PublishedContact contact;
    contact.touch = 1;
    ContactState& state = contact.state;
    state.touching = 1;
    state.velocityMps = velocityMps;
    state.hasPlace = 1;
    state.surfaceSeed = 5;
    state.placeMetres = placeMetres;
    state.firstAxis = {0.0F, 0.0F, 1.0F};
    state.secondAxis = {1.0F, 0.0F, 0.0F};
    contact.ranged.motion = {velocityMps[0], velocityMps[1], 1.0F};
    return contact;
}

TEST(PlaceTrackTest, ASegmentBeginsWhereTheTipWillBeWhenItSounds) {
    PlaceTrack track(1, 0);
    const SurfaceStretch stretch = track.at(contactAt({0.1F, 0.2F, 0.3F}, {0.2F, -0.1F}), 500, 0.02);
    EXPECT_NEAR(stretch.path.startMetres[0], 0.1 - 0.002, 1e-8);
    EXPECT_NEAR(stretch.path.startMetres[1], 0.2, 1e-8);
    EXPECT_NEAR(stretch.path.startMetres[2], 0.3 + 0.004, 1e-7);
    EXPECT_NEAR(stretch.path.stepMetres[0], -0.1 / 2000.0, 1e-9);
    EXPECT_NEAR(stretch.path.stepMetres[2], 0.2 / 2000.0, 1e-9);
}

TEST(PlaceTrackTest, SurfacesAndEnginesWithOtherSeedsHaveOtherFieldsAndVoicesShareThem) {
    const PublishedContact contact = contactAt({}, {0.1F, 0.0F});
    PublishedContact other = contact;
    other.state.surfaceSeed = 6;
    PlaceTrack track(1, 0);
    const std::uint64_t surface = track.at(contact, 0, 0.0).surface;
    EXPECT_NE(surface, track.at(other, 0, 0.0).surface);
    EXPECT_NE(surface, PlaceTrack(2, 0).at(contact, 0, 0.0).surface);
    EXPECT_EQ(surface, PlaceTrack(1, 3).at(contact, 0, 0.0).surface);
}

TEST(PlaceTrackTest, WithoutAPlaceTheVelocityIsAddedUpWithinATouch) {
    PlaceTrack track(1, 0);
    PublishedContact contact = contactAt({}, {0.1F, 0.05F});
    contact.state.hasPlace = 0;
    const SurfaceStretch first = track.at(contact, 100, 0.01);
    track.add(100, first);
    contact.state.velocityMps = {-0.2F, 0.0F};
    const SurfaceStretch second = track.at(contact, 120, 0.01);
    track.add(120, second);
    EXPECT_NEAR(second.path.startMetres[0] - first.path.startMetres[0], 0.1 * 20.0 / 2000.0, 1e-8);
    EXPECT_NEAR(second.path.startMetres[1] - first.path.startMetres[1], 0.05 * 20.0 / 2000.0, 1e-8);
    const SurfaceStretch third = track.at(contact, 160, 0.01);
    EXPECT_NEAR(third.path.startMetres[0] - second.path.startMetres[0], -0.2 * 40.0 / 2000.0, 1e-8);
    EXPECT_EQ(third.surface, first.surface);
    contact.touch = 2;
    EXPECT_NE(track.at(contact, 200, 0.01).surface, first.surface);
    EXPECT_NE(PlaceTrack(1, 1).at(contact, 200, 0.01).surface, track.at(contact, 200, 0.01).surface);
}

TEST(PlaceTrackTest, RibsHaveTheirPhaseFromThePlaceOnAFlatSurface) {
    PlaceTrack track(1, 0);
    track.begin();
    for (int step = 0; step < 20; ++step) {
        const auto metres = 0.001F * static_cast<float>(step);
        const SurfaceStretch stretch = track.at(contactAt({0.0F, 0.0F, metres}, {0.1F, 0.0F}), 28 * step, 0.0);
        ASSERT_TRUE(stretch.ribPlaceMetres);
        EXPECT_NEAR((*stretch.ribPlaceMetres)[0], static_cast<double>(metres), 1e-7);
        EXPECT_NEAR((*stretch.ribPlaceMetres)[1], 0.0, 1e-7);
    }
}

TEST(PlaceTrackTest, RibsOnACurvedSurfaceAreAddedUpUntilItHasBeenFlatForFiveMillimetres) {
    PlaceTrack track(1, 0);
    track.begin();
    int steps = 0;
    // A cylinder of 50 mm radius, then the plane that touches it.
    const auto ribsAt = [&](float angle, float metresBeyond) {
        PublishedContact contact = contactAt({}, {0.1F, 0.0F});
        contact.state.firstAxis = {0.0F, -std::sin(angle), std::cos(angle)};
        contact.state.placeMetres = {0.0F, 0.05F * std::cos(angle) - metresBeyond * std::sin(angle),
                                     0.05F * std::sin(angle) + metresBeyond * std::cos(angle)};
        ++steps;
        return track.at(contact, 28 * steps, 0.0).ribPlaceMetres.has_value();
    };
    EXPECT_TRUE(ribsAt(0.0F, 0.0F));
    for (float angle = 0.02F; angle < 1.0F; angle += 0.02F) {
        EXPECT_FALSE(ribsAt(angle, 0.0F)) << angle;
    }
    // Slowly, the axes turn by less than a milliradian from one state to the next.
    for (float angle = 1.0F; angle < 1.3F; angle += 0.0007F) {
        EXPECT_FALSE(ribsAt(angle, 0.0F)) << angle;
    }
    EXPECT_FALSE(ribsAt(1.3F, 0.0F));
    EXPECT_FALSE(ribsAt(1.3F, 0.004F));
    EXPECT_TRUE(ribsAt(1.3F, 0.006F));
}

TEST(PlaceTrackTest, RibsBeyondTheTrainedSpeedAreAddedUp) {
    PlaceTrack track(1, 0);
    PublishedContact contact = contactAt({}, {0.8F, 0.0F});
    contact.ranged.motion = {0.4F, 0.0F, 1.0F};
    EXPECT_FALSE(track.at(contact, 0, 0.0).ribPlaceMetres);
    contact.state.spatialScale = 2.0F;
    EXPECT_TRUE(track.at(contact, 28, 0.0).ribPlaceMetres);
    contact.ranged.readingRate = 1.1;
    EXPECT_FALSE(track.at(contact, 56, 0.0).ribPlaceMetres);
}

TEST(RibTrackTest, TheFirstSegmentTakesThePhaseOfThePlaceAndLaterOnesComeCloserWithoutAJump) {
    const WaveVectors vectors{WaveVector{0.5F, 0.0F}, WaveVector{}};
    RibTrack track;
    track.begin(0, {.phase = {0.9, 0.0}, .cyclesPerSample = {0.0, 0.0}, .vectors = vectors});
    // 2.5 mm are 1.25 turns.
    const RibCycles first = track.at(10, vectors, {0.0025, 0.0});
    EXPECT_NEAR(first[0], 0.25, 1e-9);
    track.add(10, vectors, first, {0.01, 0.0});
    // 0.45 turns by the track; the place says 0.47, 0.80 and 0.40.
    EXPECT_NEAR(track.at(30, vectors)[0], 0.45, 1e-9);
    EXPECT_NEAR(track.at(30, vectors, {0.00294, 0.0})[0], 0.46, 1e-9);
    EXPECT_NEAR(track.at(30, vectors, {0.0036, 0.0})[0], 0.55, 1e-9);
    EXPECT_NEAR(track.at(30, vectors, {0.0028, 0.0})[0], 0.425, 1e-9);
}

TEST(ContactPlaceTest, APlaceOfNoUseIsUnknownAndCounted) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    const auto changesOf = [](auto change) {
        ContactState state = contactAt({1.0F, 2.0F, 3.0F}, {0.1F, 0.0F}).state;
        change(state);
        const std::uint32_t changes = sanitise(state);
        EXPECT_EQ(state.hasPlace, changes == 0 ? 1U : 0U);
        EXPECT_EQ(state.placeMetres[0], changes == 0 ? 1.0F : 0.0F);
        return changes;
    };
    EXPECT_EQ(changesOf([](ContactState&) {}), 0U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.placeMetres[1] = nan; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.placeMetres[2] = 2e4F; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.firstAxis = {}; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.secondAxis = {0.0F, nan, 0.0F}; }), 1U);
    EXPECT_EQ(changesOf([](ContactState& state) { state.secondAxis = {5.0F, 0.0F, 0.0F}; }), 1U);
}

}  // namespace
}  // namespace haptoflow::engine

// The noise of a voice belongs to the place: whatever the blocks, the frames and the latencies, a place is heard with
// its own noise at the moment at which the tip is there.

namespace haptoflow::engine {
namespace {

using testing::DeviceSettings;
using testing::FakeGenerator;
using testing::SimulatedDevice;

ContactState at(double metres, double speedMps) {
    ContactState state = testing::sliding(static_cast<float>(speedMps));
    state.hasPlace = 1;
    state.surfaceSeed = 11;
    state.placeMetres = {static_cast<float>(metres), 0.0F, 0.25F};
    state.firstAxis = {1.0F, 0.0F, 0.0F};
    state.secondAxis = {0.0F, 0.0F, -1.0F};
    return state;
}

double correlation(std::span<const float> left, std::span<const float> right) {
    double product = 0.0;
    double leftPower = 0.0;
    double rightPower = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        product += static_cast<double>(left[i]) * static_cast<double>(right[i]);
        leftPower += static_cast<double>(left[i]) * static_cast<double>(left[i]);
        rightPower += static_cast<double>(right[i]) * static_cast<double>(right[i]);
    }
    return product / std::sqrt(leftPower * rightPower);
}

class PlaceTest : public ::testing::Test {
protected:
    /// What is heard on a stroke from `startMetres`, with a network that passes its noise on.
    std::vector<float> heard(const DeviceSettings& settings, double startMetres, double speedMps,
                             double seconds = 1.0) {
        SimulatedDevice device(model_, noise_, settings);
        device.run(seconds, [&](double t) { return at(startMetres + speedMps * t, speedMps); });
        EXPECT_EQ(device.counters().underruns, 0U);
        return device.waveform.samples;
    }

    /// The noise of the stroke's places, from the field itself.
    static std::vector<float> field(double startMetres, double speedMps, std::size_t count) {
        std::vector<float> noise(count);
        EXPECT_TRUE(inference::fillSurfaceNoise(
            0x9E3779B97F4A7C15U + 11U,
            {.startMetres = {startMetres, 0.0, 0.25}, .stepMetres = {speedMps / 2000.0, 0.0, 0.0}}, noise));
        return noise;
    }

    /// The best correlation of `count` samples from sample `first`, and the shift at which it is found.
    struct Match {
        double correlation = -1.0;
        double samples = 0.0;
    };
    static Match match(const std::vector<float>& heard, double startMetres, double speedMps) {
        constexpr std::size_t first = 400;
        constexpr std::size_t count = 1200;
        Match best;
        for (double samples = -20.0; samples <= 20.0; samples += 0.25) {
            const std::vector<float> expected =
                field(startMetres + speedMps / 2000.0 * (static_cast<double>(first) + samples), speedMps, count);
            const double found = correlation(std::span(heard).subspan(first, count), expected);
            if (found > best.correlation) {
                best = {found, samples};
            }
        }
        return best;
    }

    model::ModelFile model_ = testing::smallModel();
    FakeGenerator noise_{[](const inference::SegmentRequest& request, std::span<float> segment) {
        std::ranges::copy(request.noise, segment.begin());
    }};
};

TEST_F(PlaceTest, APlaceIsHeardWhenTheTipIsThereWhateverTheDevice) {
    for (const std::size_t blockFrames : {64U, 256U, 480U, 1024U}) {
        for (const double updateHz : {60.0, 72.0, 90.0, 120.0}) {
            for (const double latency : {0.002, 0.02}) {
                DeviceSettings settings;
                settings.blockFrames = blockFrames;
                settings.updateHz = updateHz;
                settings.latencySeconds = [latency](double) { return latency; };
                settings.readsClock = true;
                const Match found = match(heard(settings, 0.05, 0.1), 0.05, 0.1);
                EXPECT_GT(found.correlation, 0.999) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
                // The output's delay of three samples is anticipated; two of them are the samples that the resampler
                // reads before the first sounds.
                EXPECT_NEAR(found.samples, 1.0, 0.05) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
            }
        }
    }
}

TEST_F(PlaceTest, AnotherPlaceHasOtherNoise) {
    DeviceSettings settings;
    settings.readsClock = true;
    const std::vector<float> first = heard(settings, 0.05, 0.1);
    EXPECT_GT(match(first, 0.05, 0.1).correlation, 0.6);
    EXPECT_LT(match(first, 0.25, 0.1).correlation, 0.2);
}

TEST_F(PlaceTest, WithoutAPlaceTheNoiseIsWhiteAndDiffersFromTouchToTouch) {
    std::vector<float> touches[2];
    SimulatedDevice device(model_, noise_, {});
    for (std::uint32_t touch = 1; touch <= 2; ++touch) {
        const std::size_t before = device.waveform.samples.size();
        device.run(0.6, [touch](double) {
            ContactState state = testing::sliding(0.1F);
            state.touchCounter = touch;
            return state;
        });
        device.run(0.1, [touch](double) { return testing::lifted(touch); });
        touches[touch - 1].assign(device.waveform.samples.begin() + static_cast<std::ptrdiff_t>(before + 300),
                                  device.waveform.samples.begin() + static_cast<std::ptrdiff_t>(before + 1100));
    }
    EXPECT_NEAR(correlation(touches[0], touches[1]), 0.0, 0.15);
    double power = 0.0;
    for (const float sample : touches[0]) {
        power += static_cast<double>(sample) * static_cast<double>(sample) / 800.0;
    }
    EXPECT_NEAR(power, 1.0, 0.2);
}

}  // namespace
}  // namespace haptoflow::engine
