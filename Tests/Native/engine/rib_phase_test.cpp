#include "engine/live_engine.hpp"
#include "engine/offline_renderer.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

// The phase of ribs belongs to the surface: each request contains the distance that the tip has travelled along the
// ribs.

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
/// A sinusoid of amplitude sqrt(2) at 35 ribs per second changes by up to 0.16 between samples; at a change of rate,
/// the splice adds to that. A phase jump by a tenth of a turn changes it by up to 0.9.
constexpr float largestStepWithoutAJump = 0.25F;

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

/// A model with two ruled labels, the second with finer ribs. Each has one seed: the sinusoid of its ribs at 0.1 m/s
/// along x, with its own phase.
model::ModelFile ribModel() {
    model::testing::ModelBuilder builder;
    std::vector<float> embedding(2 * model::embeddingSize, 0.5F);
    std::vector<float> seeds(2 * model::seedSamples);
    auto entries = nlohmann::json::array();
    const std::array<float, 2> waveNumbers{coarse, fine};
    const std::array<double, 2> phases{seedPhase, otherSeedPhase};
    for (std::size_t label = 0; label < 2; ++label) {
        float* const row = embedding.data() + label * model::embeddingSize;
        const std::array<float, 4> waveVectors{waveNumbers[label], 0.0F, 0.0F, 2.0F * waveNumbers[label]};
        std::ranges::copy(waveVectors, row + 60);
        for (std::size_t i = 0; i < model::seedSamples; ++i) {
            const double cycles = (static_cast<double>(i) - 200.0) *
                                  cyclesPerSample(waveVectors, {static_cast<float>(seedSpeedMps), 0.0F, 1.0F});
            seeds[label * model::seedSamples + i] = ribs(phases[label] + cycles);
        }
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
        ratesHz_.push_back({request.phases[3], request.phases[4], request.phases[5]});
        speedsMps_.push_back(request.motion[0]);
        turns_.push_back(cyclesPerSample(std::span(request.embedding).subspan(60, 2), request.motion));
        ribsOf(request, segment);
    }};
    // The phases of each request.
    std::vector<std::array<float, 2>> phases_;
    // Of both families of ribs and of stick-slip.
    std::vector<std::array<float, 3>> ratesHz_;
    std::vector<float> speedsMps_;
    std::vector<double> turns_;

    void forget() {
        phases_.clear();
        speedsMps_.clear();
        turns_.clear();
    }

    static std::optional<ContactState> slide(double) { return onLabel(0); }

    /// Expects the phase of each segment to continue that of the newest segment that started at or before it, and the
    /// first segment to continue the seed.
    void expectEachPhaseToFollow(const SimulatedDevice& device, double firstPhase, double seedTurns) const {
        const std::vector<std::int64_t>& starts = device.waveform.seams;
        ASSERT_EQ(device.counters().dropped + device.counters().late, 0U) << "every request must have a seam";
        ASSERT_LE(starts.size(), phases_.size());
        for (std::size_t i = 0; i < starts.size(); ++i) {
            std::size_t before = i;
            while (before > 0 && starts[before - 1] > starts[i]) {
                --before;
            }
            const double expected = before == 0
                                        ? firstPhase + seedTurns * static_cast<double>(starts[i])
                                        : static_cast<double>(phases_[before - 1][0]) +
                                              turns_[before - 1] * static_cast<double>(starts[i] - starts[before - 1]);
            const double gap = static_cast<double>(phases_[i][0]) - expected;
            ASSERT_NEAR(gap, std::round(gap), 1e-5) << "segment " << i << " at " << starts[i];
        }
    }

    /// The largest difference between the played waveform and the sinusoid of the ribs since touch-down, at constant
    /// speed.
    static double largestError(std::span<const float> played, double firstPhase, double cycles) {
        double largest = 0.0;
        for (std::size_t i = 0; i < played.size(); ++i) {
            const double expected = static_cast<double>(ribs(firstPhase + cycles * static_cast<double>(i)));
            largest = std::max(largest, std::abs(static_cast<double>(played[i]) - expected));
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
            EXPECT_LT(largestError(device.waveform.samples, seedPhase, 0.01), 2e-3) << updateHz << " Hz, " << latency;
        }
    }
}

TEST_F(RibPhaseTest, AReversedStrokeCrossesTheSameRibsBackwards) {
    SimulatedDevice device(model_, generator_);
    device.run(1.0, slide);
    device.run(0.9, [](double) { return onLabel(0, -static_cast<float>(seedSpeedMps)); });
    const auto back = std::ranges::find_if(speedsMps_, [](float speed) { return speed < 0.0F; });
    ASSERT_EQ(device.counters().dropped, 0U) << "every request must have a seam";
    const auto turn = static_cast<std::size_t>(
        device.waveform.seams.at(static_cast<std::size_t>(std::distance(speedsMps_.begin(), back))));
    const std::vector<float>& played = device.waveform.samples;
    ASSERT_GT(played.size(), turn + 1500);
    for (std::size_t n = 5; n < 1500; ++n) {
        ASSERT_NEAR(played[turn + n], played[turn - n], 3e-3F) << n << " samples from the turn";
    }
}

TEST_F(RibPhaseTest, SpeedChangesAtEveryUpdateMakeNoPhaseJump) {
    for (const std::size_t blockFrames : {64U, 256U, 1024U}) {
        for (const double updateHz : {30.0, 72.0, 120.0}) {
            SCOPED_TRACE(std::to_string(blockFrames) + " frames, " + std::to_string(updateHz) + " Hz");
            DeviceSettings settings;
            settings.blockFrames = blockFrames;
            settings.updateHz = updateHz;
            forget();
            SimulatedDevice device(model_, generator_, settings);
            device.run(3.0, [](double t) {
                return onLabel(0, 0.1F + 0.07F * static_cast<float>(std::sin(2.0 * std::numbers::pi * 1.7 * t)));
            });
            ASSERT_GT(device.counters().inferences, 60U);
            expectEachPhaseToFollow(device, seedPhase, 0.01);
            EXPECT_LT(testing::largestStep(device.waveform.samples), largestStepWithoutAJump);
        }
    }
}

TEST_F(RibPhaseTest, ATouchBeginsWithThePhaseOfItsSeed) {
    SimulatedDevice device(model_, generator_);
    device.run(0.3, [](double) { return onLabel(1, 0.03F); });
    const auto first = static_cast<double>(device.waveform.seams.front());
    const double expected = otherSeedPhase + 0.0175 * first;
    EXPECT_NEAR(phases_.front()[0], expected - std::floor(expected), 1e-5);
    EXPECT_NEAR(phases_.front()[1], 0.125F, 1e-6F)
        << "the seed was recorded without motion along the second wave vector";
}

TEST_F(RibPhaseTest, AFailedRunDoesNotAdvanceThePhase) {
    int runs = 0;
    FakeGenerator failing([&](const SegmentRequest& request, std::span<float> segment) {
        if (++runs % 3 == 0) {
            throw inference::InferenceError("a test says so");
        }
        ribsOf(request, segment);
    });
    SimulatedDevice device(model_, failing);
    device.run(2.0, [](double t) { return onLabel(0, t < 1.0 ? 0.1F : 0.04F); });
    ASSERT_GT(device.counters().failures, 20U);
    EXPECT_LT(testing::largestStep(device.waveform.samples), largestStepWithoutAJump);
}

TEST_F(RibPhaseTest, LiveVoiceAndOfflineRendererHaveTheSameRibPhases) {
    const auto hand = [](double t) {
        return TimedContactState{onLabel(0, 0.1F + 0.06F * static_cast<float>(std::sin(2.0 * std::numbers::pi * t))),
                                 t};
    };
    std::vector<TimedContactState> states;
    for (int update = 0; update < 144; ++update) {
        states.push_back(hand(update / 72.0));
    }
    const OfflineRender offline = renderOffline(model_, generator_, states, {.leadMs = 8.0});
    DeviceSettings settings;
    settings.fixedLeadSamples = 16;
    settings.blockFrames = 48;
    SimulatedDevice device(model_, generator_, settings);
    device.run(2.0, hand);
    const std::size_t common = std::min(offline.waveformMps2.size(), device.waveform.samples.size());
    ASSERT_GT(common, 3500U);
    // With blocks of 1 ms, the tip may be up to a sixtieth of a rib further.
    double largest = 0.0;
    for (std::size_t i = 0; i < common; ++i) {
        const double difference = static_cast<double>(offline.waveformMps2[i] - device.waveform.samples[i]);
        largest = std::max(largest, std::abs(difference));
    }
    EXPECT_LT(largest, std::numbers::sqrt2 * 2.0 * std::numbers::pi * 0.05);
    EXPECT_LT(testing::largestStep(std::span<const float>(offline.waveformMps2).first(common)),
              largestStepWithoutAJump);
}

}  // namespace
}  // namespace haptoflow::engine
