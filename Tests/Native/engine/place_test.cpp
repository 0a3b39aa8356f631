#include "skeleton/surface_noise.hpp"

#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

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
        constexpr std::size_t pieceSamples = 32;
        const double stepMetres = speedMps / 2000.0;
        skeleton::SurfaceNoise surfaceNoise;
        std::vector<float> noise(count);
        for (std::size_t first = 0; first < count; first += pieceSamples) {
            surfaceNoise.next(0x9E3779B97F4A7C15U + 11U,
                              {.startMetres = {startMetres + stepMetres * static_cast<double>(first), 0.0, 0.25},
                               .stepMetres = {stepMetres, 0.0, 0.0}},
                              {}, std::span(noise).subspan(first, std::min(pieceSamples, count - first)));
        }
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
    FakeGenerator noise_{testing::whiteNoise};
};

TEST_F(PlaceTest, APlaceIsHeardWhenTheTipIsThereWhateverTheDevice) {
    for (const std::size_t blockFrames : {64U, 480U, 1024U}) {
        for (const double updateHz : {60.0, 90.0}) {
            for (const double latency : {0.002, 0.02}) {
                DeviceSettings settings;
                settings.blockFrames = blockFrames;
                settings.updateHz = updateHz;
                settings.latencySeconds = [latency](double) { return latency; };
                settings.readsClock = true;
                const Match found = match(heard(settings, 0.05, 0.1), 0.05, 0.1);
                EXPECT_GT(found.correlation, 0.999) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
                // The output is three samples late, which is anticipated; two of them are read ahead at the onset.
                EXPECT_NEAR(found.samples, 1.0, 0.05) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
            }
        }
    }
}

TEST_F(PlaceTest, AnotherPlaceHasOtherNoise) {
    DeviceSettings settings;
    settings.readsClock = true;
    const std::vector<float> first = heard(settings, 0.05, 0.1);
    EXPECT_GT(match(first, 0.05, 0.1).correlation, 0.999);
    EXPECT_LT(match(first, 0.25, 0.1).correlation, 0.2);
}

TEST_F(PlaceTest, WithoutAPlaceTheNoiseIsWhiteAndDiffersFromTouchToTouch) {
    std::array<std::vector<float>, 2> touches;
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
    for (const std::vector<float>& touch : touches) {
        EXPECT_NEAR(haptoflow::testing::levelDecibels(touch), 0.0, 1.0);
        EXPECT_NEAR(correlation(std::span(touch).first(799), std::span(touch).last(799)), 0.0, 0.15);
    }
}

}  // namespace
}  // namespace haptoflow::engine
