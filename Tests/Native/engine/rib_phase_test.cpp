#include "engine/offline_renderer.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <vector>

// The phase of ribs belongs to the surface: each request contains the distance that the tip has travelled along the
// ribs. The waveform of these tests is zero until the first segment arrives.

namespace haptoflow::engine {
namespace {

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

float ribs(double cycles) {
    return static_cast<float>(std::numbers::sqrt2 * std::sin(2.0 * std::numbers::pi * cycles));
}

/// The output of an ideal network for a ruled surface: a sinusoid with the phase of the request.
void ribsOf(const SegmentRequest& request, std::span<float> segment) {
    const double step = cyclesPerSample(std::span(request.embedding).subspan(60, 2), request.motion);
    for (std::size_t i = 0; i < segment.size(); ++i) {
        segment[i] = ribs(static_cast<double>(request.phases[0]) + step * static_cast<double>(i));
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
            largest = std::max(largest, std::abs(played[i] - ribs(firstPhase + cycles * static_cast<double>(i + 1))));
        }
        return largest;
    }
};

TEST_F(RibPhaseTest, AtConstantSpeedTheRibsContinueTheSeedsWithoutAJump) {
    for (const double updateHz : {30.0, 72.0, 120.0}) {
        for (const double latency : {0.002, 0.012, 0.045}) {
            DeviceSettings settings;
            settings.updateHz = updateHz;
            settings.latencySeconds = [latency](double) { return latency; };
            SimulatedDevice device(model_, generator_, settings);
            device.run(2.0, slide);
            ASSERT_GT(device.waveform.samples.size(), 3000U);
            ASSERT_GT(device.counters().inferences, 20U);
            EXPECT_LT(largestError(device, seedPhase, 0.01), 2e-3F) << updateHz << " Hz, " << latency;
        }
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
            DeviceSettings settings;
            settings.blockFrames = blockFrames;
            settings.updateHz = updateHz;
            settings.fixedLeadSamples = leadSamples;
            forget();
            SimulatedDevice device(model_, generator_, settings);
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
    DeviceSettings settings;
    settings.latencySeconds = [](double) { return 0.0; };
    SimulatedDevice device(model_, generator_, settings);
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
    const std::vector<TimedContactState> states = testing::statesOf(2.0, hand);
    const OfflineRender offline = renderOffline(model_, generator_, states, {.leadMs = 8.0});
    DeviceSettings settings;
    settings.fixedLeadSamples = 16;
    settings.blockFrames = 48;
    SimulatedDevice device(model_, generator_, settings);
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

}  // namespace
}  // namespace haptoflow::engine
