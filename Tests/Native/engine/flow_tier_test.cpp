#include "engine/offline_renderer.hpp"
#include "simulated_device.hpp"
#include "skeleton/surface_noise.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <vector>

// The phase of ribs belongs to the surface: each request contains the distance that the tip has travelled along the
// ribs. The waveform of these tests is zero until the first segment arrives.

namespace haptoflow::engine {
namespace {

using haptoflow::testing::correlation;
using inference::SegmentRequest;
using testing::DeviceSettings;
using testing::FakeGenerator;
using testing::SimulatedDevice;

constexpr double seedPhase = 0.3;
constexpr double otherSeedPhase = 0.75;
constexpr double seedSpeedMps = 0.1;
/// Cycles per millimetre; at 0.1 m/s, the tip crosses 20 ribs per second.
constexpr float coarse = 0.2F;
constexpr float fine = 0.35F;
/// The first segment fades in over 5 ms.
constexpr std::size_t fadeInSamples = 14;

double cyclesPerSample(std::span<const float> waveVector, const std::array<float, 3>& motion) {
    return (static_cast<double>(waveVector[0]) * static_cast<double>(motion[0]) +
            static_cast<double>(waveVector[1]) * static_cast<double>(motion[1])) *
           1000.0 / inference::waveformRateHz;
}

float ribWave(double cycles) {
    return static_cast<float>(std::numbers::sqrt2 * std::sin(2.0 * std::numbers::pi * cycles));
}

/// The output of an ideal network for a ruled surface: a sinusoid with the phase of the request.
void ribsOf(const SegmentRequest& request, std::span<float> segment) {
    const double step = cyclesPerSample(std::span(request.embedding).subspan(60, 2), request.motion);
    for (std::size_t i = 0; i < segment.size(); ++i) {
        segment[i] = ribWave(static_cast<double>(request.phases[0]) + step * static_cast<double>(i));
    }
}

/// A model with two ruled labels, the second with finer ribs. Each has one seed along x, with its own phase.
model::ModelFile ribModel() {
    model::testing::ModelBuilder builder;
    std::vector<float> embedding(2 * model::embeddingSize, 0.5F);
    const std::vector<float> seeds(2 * model::seedSamples, 1.0F);
    auto entries = nlohmann::json::array();
    const std::array<float, 2> waveNumbers{coarse, fine};
    const std::array<double, 2> phases{seedPhase, otherSeedPhase};
    for (std::size_t label = 0; label < 2; ++label) {
        setWaveVectors(std::span(embedding).subspan(label * model::embeddingSize).first<model::embeddingSize>(),
                       {skeleton::WaveVector{waveNumbers[label], 0.0F}, {0.0F, 2.0F * waveNumbers[label]}});
        entries.push_back({{"label", label == 0 ? "oak" : "metal mesh"},
                           {"velocity_mps", {seedSpeedMps, 0.0}},
                           {"force_newtons", 1.0},
                           {"rib_phase", {phases[label], 0.125}}});
    }
    builder.header["seed_bank"]["entries"] = entries;
    builder.blobs[0].bytes = model::testing::bytesOf(embedding);
    builder.blobs[1].shape = {2, 400};
    builder.blobs[1].bytes = model::testing::bytesOf(seeds);
    return model::ModelFile::parse(builder.build());
}

ContactState onLabel(std::uint32_t label, float speedMps = static_cast<float>(seedSpeedMps)) {
    ContactState state = testing::sliding(speedMps);
    state.material.labels[0] = label;
    return state;
}

class RibPhaseTest : public ::testing::Test {
protected:
    model::ModelFile model_ = ribModel();
    FakeGenerator generator_{[this](const SegmentRequest& request, std::span<float> segment) {
        phases_.push_back({request.phases[0], request.phases[1]});
        speedsMps_.push_back(request.motion[0]);
        turns_.push_back(cyclesPerSample(std::span(request.embedding).subspan(60, 2), request.motion));
        ribsOf(request, segment);
    }};
    // Of each request.
    std::vector<std::array<float, 2>> phases_;
    std::vector<float> speedsMps_;
    std::vector<double> turns_;

    void forget() {
        phases_.clear();
        speedsMps_.clear();
        turns_.clear();
    }

    static std::optional<ContactState> slide(double) { return onLabel(0); }

    /// Once the first segment sounds, without its beginning.
    static std::size_t firstSample(const SimulatedDevice& device) {
        return static_cast<std::size_t>(device.waveform.seams.at(0)) + fadeInSamples;
    }

    /// The largest difference between the played waveform and the sinusoid of the ribs since touch-down, at constant
    /// speed.
    static float largestError(const SimulatedDevice& device, double firstPhase, double cycles) {
        const std::vector<float>& played = device.waveform.samples;
        float largest = 0.0F;
        for (std::size_t i = firstSample(device); i < played.size(); ++i) {
            // The output is three samples late, which is anticipated; two of them are read ahead at the onset.
            largest =
                std::max(largest, std::abs(played[i] - ribWave(firstPhase + cycles * static_cast<double>(i + 1))));
        }
        return largest;
    }
};

TEST_F(RibPhaseTest, AtConstantSpeedTheRibsContinueTheSeedsWithoutAJump) {
    for (const double updateHz : {30.0, 72.0, 120.0}) {
        for (const double latency : {0.002, 0.012, 0.045}) {
            SimulatedDevice device(model_, generator_,
                                   {.updateHz = updateHz, .latencySeconds = [latency](double) { return latency; }});
            device.run(2.0, slide);
            ASSERT_GT(device.waveform.samples.size(), 3000U);
            ASSERT_GT(device.counters().inferences, 20U);
            EXPECT_LT(largestError(device, seedPhase, 0.01), 2e-3F) << updateHz << " Hz, " << latency;
        }
    }
}

TEST_F(RibPhaseTest, OnALargerScaleTheRibsAreCrossedAtTheSpeedDividedByIt) {
    for (const float scale : {2.0F, 0.5F, 4.0F}) {
        SimulatedDevice device(model_, generator_);
        device.run(0.5, [scale](double) {
            ContactState state = onLabel(0);
            state.spatialScale = scale;
            return state;
        });
        ASSERT_GT(device.waveform.samples.size(), 800U);
        EXPECT_LT(largestError(device, seedPhase, 0.01 / static_cast<double>(scale)), 2e-3F) << scale;
        EXPECT_FLOAT_EQ(speedsMps_.back(), 0.1F / scale);
    }
}

TEST_F(RibPhaseTest, AReversedStrokeCrossesTheSameRibsBackwards) {
    SimulatedDevice device(model_, generator_);
    device.run(1.0, slide);
    std::size_t turn = 0;
    device.run(0.9, [&](double) {
        if (turn == 0) {
            turn = static_cast<std::size_t>(device.voice().renderer.voice().waveform().head() - device.waveform.origin);
        }
        return onLabel(0, -static_cast<float>(seedSpeedMps));
    });
    const auto back = std::ranges::find_if(speedsMps_, [](float speed) { return speed < 0.0F; });
    ASSERT_EQ(device.counters().dropped, 0U) << "every request must have a seam";
    // Until the first segment backwards, the last one forwards is heard.
    const auto seam = static_cast<std::size_t>(
        device.waveform.seams.at(static_cast<std::size_t>(std::distance(speedsMps_.begin(), back))));
    const std::vector<float>& played = device.waveform.samples;
    ASSERT_GT(played.size(), turn + 1500);
    ASSERT_LT(seam, turn + 40);
    for (std::size_t n = seam - turn + 5; n < 1500; ++n) {
        ASSERT_NEAR(played[turn + n], played[turn - n], 3e-3F) << n << " samples from the turn";
    }
}

TEST_F(RibPhaseTest, SpeedChangesAtEveryUpdateMakeNoPhaseJump) {
    for (const std::size_t blockFrames : {64U, 256U, 1024U}) {
        for (const double updateHz : {30.0, 72.0, 120.0}) {
            SCOPED_TRACE(std::to_string(blockFrames) + " frames, " + std::to_string(updateHz) + " Hz");
            constexpr std::int64_t leadSamples = 60;
            forget();
            SimulatedDevice device(model_, generator_,
                                   {.blockFrames = blockFrames, .updateHz = updateHz, .fixedLeadSamples = leadSamples});
            device.run(3.0, [](double t) {
                return onLabel(0, 0.1F + 0.07F * static_cast<float>(std::sin(2.0 * std::numbers::pi * 1.7 * t)));
            });
            const std::vector<std::int64_t>& seams = device.waveform.seams;
            ASSERT_EQ(device.counters().dropped, 0U) << "every request must have a seam";
            ASSERT_GT(seams.size(), 60U);
            // The stream has the new speed from the block on at which the lead begins. The first segment is late.
            for (std::size_t i = 2; i < seams.size(); ++i) {
                const double gone = turns_[i - 1] * static_cast<double>(seams[i] - seams[i - 1]) +
                                    (turns_[i] - turns_[i - 1]) * static_cast<double>(leadSamples);
                const double gap = static_cast<double>(phases_[i][0] - phases_[i - 1][0]) - gone;
                ASSERT_NEAR(gap, std::round(gap), 1e-5) << "segment " << i << " at " << seams[i];
            }
        }
    }
}

TEST_F(RibPhaseTest, ATouchBeginsWithThePhaseOfItsSeed) {
    SimulatedDevice device(model_, generator_, {.latencySeconds = [](double) { return 0.0; }});
    device.run(0.3, [](double) { return onLabel(1, 0.03F); });
    const double expected = otherSeedPhase + 0.00525 * static_cast<double>(device.waveform.seams.front() + 1);
    EXPECT_NEAR(phases_.front()[0], expected - std::floor(expected), 1e-5);
    EXPECT_NEAR(phases_.front()[1], 0.125F, 1e-6F) << "the tip does not move along the second wave vector";
}

TEST_F(RibPhaseTest, AFailedRunLeavesThePhaseAlone) {
    int runs = 0;
    FakeGenerator failing([&](const SegmentRequest& request, std::span<float> segment) {
        if (++runs % 3 == 0) {
            throw inference::InferenceError("a test says so");
        }
        ribsOf(request, segment);
    });
    SimulatedDevice device(model_, failing);
    device.run(2.0, slide);
    ASSERT_GT(device.counters().failures, 20U);
    EXPECT_LT(largestError(device, seedPhase, 0.01), 2e-3F);
}

TEST_F(RibPhaseTest, LiveVoiceAndOfflineRendererHaveTheSameRibPhases) {
    const auto hand = [](double t) {
        return onLabel(0, 0.1F + 0.06F * static_cast<float>(std::sin(2.0 * std::numbers::pi * t)));
    };
    const OfflineRender offline = renderOffline(model_, generator_, testing::statesOf(2.0, hand), {.leadMs = 8.0});
    SimulatedDevice device(model_, generator_, {.blockFrames = 48, .fixedLeadSamples = 16});
    device.run(2.0, hand);
    const std::size_t common = std::min(offline.waveformMps2.size(), device.waveform.samples.size());
    ASSERT_GT(common, 3500U);
    // With blocks of 1 ms, the tip may be up to a sixtieth of a rib further.
    float largest = 0.0F;
    for (std::size_t i = firstSample(device); i < common; ++i) {
        largest = std::max(largest, std::abs(offline.waveformMps2[i] - device.waveform.samples[i]));
    }
    EXPECT_LT(largest, std::numbers::sqrt2_v<float> * 2.0F * std::numbers::pi_v<float> * 0.05F);
}

// The noise of a voice belongs to the place: whatever the blocks, the frames and the latencies, a place is heard with
// its own noise at the moment at which the tip is there.

class PlaceTest : public ::testing::Test {
protected:
    /// What is heard on a stroke from `startMetres`, with a network that passes its noise on.
    std::vector<float> heard(const DeviceSettings& settings, double startMetres, double speedMps,
                             double seconds = 1.0) {
        SimulatedDevice device(model_, noise_, settings);
        device.run(seconds, [&](double t) {
            return testing::slidingAt(startMetres + speedMps * t, static_cast<float>(speedMps));
        });
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
            surfaceNoise.next(0x9E3779B97F4A7C15U + 3U,
                              {.startMetres = {startMetres + stepMetres * static_cast<double>(first), 0.0, 0.0},
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
                const DeviceSettings settings{.blockFrames = blockFrames,
                                              .updateHz = updateHz,
                                              .latencySeconds = [latency](double) { return latency; },
                                              .readsClock = true};
                const Match found = match(heard(settings, 0.05, 0.1), 0.05, 0.1);
                EXPECT_GT(found.correlation, 0.999) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
                // The output is three samples late, which is anticipated; two of them are read ahead at the onset.
                EXPECT_NEAR(found.samples, 1.0, 0.05) << blockFrames << " frames, " << updateHz << " Hz, " << latency;
            }
        }
    }
}

TEST_F(PlaceTest, AnotherPlaceHasOtherNoise) {
    const std::vector<float> first = heard({.readsClock = true}, 0.05, 0.1);
    EXPECT_GT(match(first, 0.05, 0.1).correlation, 0.999);
    EXPECT_LT(match(first, 0.25, 0.1).correlation, 0.2);
}

TEST_F(PlaceTest, WithoutAPlaceTheNoiseIsWhiteAndDiffersFromTouchToTouch) {
    std::array<std::vector<float>, 2> touches;
    SimulatedDevice device(model_, noise_, {});
    for (std::uint32_t touch = 1; touch <= 2; ++touch) {
        const std::size_t before = device.waveform.samples.size();
        device.run(0.6, [touch](double) {
            ContactState state = testing::sliding();
            state.touchCounter = touch;
            return state;
        });
        device.run(0.1, [touch](double) { return testing::lifted(touch); });
        touches[touch - 1].assign(device.waveform.samples.begin() + static_cast<std::ptrdiff_t>(before + 300),
                                  device.waveform.samples.begin() + static_cast<std::ptrdiff_t>(before + 1100));
    }
    EXPECT_NEAR(correlation(touches[0], touches[1]), 0.0, 0.15);
    for (const std::vector<float>& touch : touches) {
        EXPECT_NEAR(testing::levelDecibels(touch), 0.0, 1.0);
        EXPECT_NEAR(correlation(std::span(touch).first(799), std::span(touch).last(799)), 0.0, 0.15);
    }
}

}  // namespace
}  // namespace haptoflow::engine
