#include "engine/tap_pieces.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <random>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;
using effects::EffectMask;
using effects::maskOf;
using testing::SimulatedDevice;

constexpr float silence = 1e-3F / 60.0F;

ContactState landing(float approachSpeedMps, EffectMask mask, std::uint32_t touch = 1) {
    ContactState state = testing::sliding(0.0F);
    state.touchCounter = touch;
    state.approachSpeedMps = approachSpeedMps;
    state.effects = mask;
    return state;
}

class VoiceEffectsTest : public testing::DeviceTest {
protected:
    static constexpr EffectMask texture = maskOf(EffectKind::texture);
    static constexpr EffectMask impact = maskOf(EffectKind::impact);
    static constexpr EffectMask edge = maskOf(EffectKind::edge);
};

TEST_F(VoiceEffectsTest, AnImpactAtRestSoundsWithoutInference) {
    SimulatedDevice device(model_, tone_);
    device.run(0.05, [](double) { return testing::lifted(0); });
    device.run(0.5, [](double) { return landing(0.3F, texture | impact); });
    EXPECT_GT(testing::peak(device.output), 0.05F);
    EXPECT_EQ(of(device, EffectKind::impact).events, 1U);
    EXPECT_GT(of(device, EffectKind::impact).samples, 480U);
    EXPECT_EQ(device.counters().inferences, 0U);
    EXPECT_EQ(device.counters().onsets, 0U);
}

TEST_F(VoiceEffectsTest, EffectsThatASurfaceLacksNeverRun) {
    SimulatedDevice device(model_, tone_);
    int update = 0;
    device.run(1.0, [&update](double) {
        ContactState state = testing::sliding(0.2F);
        state.approachSpeedMps = 0.5F;
        state.touchCounter = static_cast<std::uint32_t>(update++ / 10 + 1);
        state.material.labels[0] = static_cast<std::uint32_t>(update % 2);
        return state;
    });
    for (const EffectCounters& counters : device.counters().effects) {
        EXPECT_EQ(counters.prepared + counters.runs + counters.samples + counters.nanoseconds + counters.events, 0U);
    }
    EXPECT_GT(device.counters().inferences, 10U);
}

TEST_F(VoiceEffectsTest, ATextureCanBeSwitchedOffAndOnWhileSliding) {
    SimulatedDevice device(model_, tone_);
    const auto with = [](EffectMask mask) {
        return [mask](double) {
            ContactState state = testing::sliding();
            state.effects = mask;
            return state;
        };
    };
    device.run(0.3, with(texture));
    const std::size_t off = device.output.size();
    device.run(0.3, with(impact));
    EXPECT_LT(testing::peak(from(device, off + 256 + 700 + 256)), silence);
    const std::size_t on = device.output.size();
    device.run(0.3, with(texture));
    EXPECT_GT(testing::peak(from(device, on)), 0.2F / 60.0F);
    EXPECT_LT(testing::largestStep(device.output), 0.02F);
}

/// A state that alternates between two labels every 100 ms.
ContactState crossing(double seconds, float speedMps, EffectMask mask) {
    ContactState state = testing::sliding(speedMps);
    state.effects = mask;
    state.material.labels[0] = static_cast<int>(std::floor(seconds / 0.1)) % 2 == 0 ? 0U : 1U;
    return state;
}

/// Generates silence, and gives the model's first label ten times the level of the others.
class LoudFirstLabel final : public inference::SegmentGenerator {
public:
    explicit LoudFirstLabel(const model::ModelFile& model) : model_(model) {}
    void generate(std::span<const inference::SegmentRequest>, std::span<float> segments) override {
        std::ranges::fill(segments, 0.0F);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        std::ranges::transform(requests, levelsMps2.begin(), [this](const inference::SegmentRequest& request) {
            return std::ranges::equal(request.embedding, model_.embedding(0)) ? 1.0F : 0.1F;
        });
    }

private:
    const model::ModelFile& model_;
};

TEST_F(VoiceEffectsTest, AChangeOfLevelGivesAnEdgeInProportionToTheSpeed) {
    LoudFirstLabel generator(model_);
    const auto peakAt = [&](float speedMps) {
        SimulatedDevice device(model_, generator);
        device.run(0.55, [speedMps](double seconds) { return crossing(seconds, speedMps, edge); });
        EXPECT_EQ(of(device, EffectKind::edge).events, 5U) << speedMps;
        return static_cast<double>(testing::peak(device.output));
    };
    EXPECT_NEAR(peakAt(0.2F) / peakAt(0.05F), 4.0, 0.2);
}

TEST_F(VoiceEffectsTest, WithoutALevelChangeHeightOrSpeedThereIsNoEdge) {
    SimulatedDevice device(model_, tone_);
    // All labels of this generator have the same level.
    device.run(0.5, [](double seconds) { return crossing(seconds, 0.2F, edge); });
    // At rest, a change of label gives no edge.
    device.run(0.5, [](double seconds) {
        ContactState state = crossing(seconds, 0.0F, edge);
        // The newest speeds still contain those of some earlier states.
        state.edgeCounter = seconds < 0.58 ? 0U : static_cast<std::uint32_t>(seconds / 0.05);
        state.edgeHeightMetres = 0.01F;
        return state;
    });
    EXPECT_EQ(of(device, EffectKind::edge).events, 0U);
    EXPECT_EQ(testing::peak(device.output), 0.0F);
}

TEST_F(VoiceEffectsTest, AnEdgeGrowsWithItsHeightUpToTheTipsWidth) {
    const auto peakAt = [this](float heightMetres) {
        SimulatedDevice device(model_, tone_);
        device.run(0.2, [heightMetres](double seconds) {
            ContactState state = testing::sliding(0.2F);
            state.effects = edge;
            state.edgeCounter = seconds < 0.1 ? 0U : 1U;
            state.edgeHeightMetres = heightMetres;
            return state;
        });
        return static_cast<double>(testing::peak(device.output));
    };
    EXPECT_EQ(peakAt(0.0F), 0.0);
    EXPECT_NEAR(peakAt(0.001F) / peakAt(0.0005F), 2.0, 0.05);
    EXPECT_DOUBLE_EQ(peakAt(0.5F), peakAt(0.002F));
    EXPECT_EQ(peakAt(std::numeric_limits<float>::quiet_NaN()), 0.0);
}

TEST_F(VoiceEffectsTest, ALandingWithinATouchGivesAnImpactAndTheTextureContinues) {
    SimulatedDevice device(model_, tone_);
    std::uint32_t landings = 0;
    const auto slideOn = [&landings](double) {
        ContactState state = testing::sliding(0.2F);
        state.effects = texture | impact;
        state.approachSpeedMps = 0.3F;
        state.landingCounter = landings;
        return state;
    };
    device.run(0.3, slideOn);
    // The touch-down is the first impact.
    EXPECT_EQ(of(device, EffectKind::impact).events, 1U);
    landings = 1;
    device.run(0.3, slideOn);
    EXPECT_EQ(of(device, EffectKind::impact).events, 2U);
    EXPECT_EQ(device.counters().onsets, 1U);
}

TEST_F(VoiceEffectsTest, AnImpactWhileSlidingAddsToTheTexture) {
    const auto play = [this](float approachSpeedMps) {
        SimulatedDevice device(model_, tone_, {.fixedLeadSamples = 16});
        device.run(0.4, [approachSpeedMps](double seconds) {
            ContactState state = testing::sliding();
            state.effects = texture | impact;
            state.touchCounter = seconds < 0.2 ? 1U : 2U;
            state.approachSpeedMps = seconds < 0.2 ? 0.0F : approachSpeedMps;
            return state;
        });
        return device.output;
    };
    const std::vector<float> without = play(0.0F);
    const std::vector<float> with = play(0.05F);
    std::vector<float> event(with.size());
    std::ranges::transform(with, without, event.begin(), std::minus<>());
    EXPECT_EQ(testing::peak(std::span<const float>(event).first(9000)), 0.0F);
    const double peak = 60.0 * static_cast<double>(testing::peak(event));
    const double expected =
        0.05 * static_cast<double>(impactResponse(model_.header().labels[0]).modes[0].gainPerSecond);
    EXPECT_GT(peak, 0.6 * expected);
    EXPECT_LT(peak, 1.01 * expected);
}

TEST_F(VoiceEffectsTest, APanicSilencesAnImpactAndTheNextTouchSounds) {
    SimulatedDevice device(model_, tone_);
    device.publish(landing(0.5F, impact, 1));
    device.renderBlock();
    EXPECT_GT(testing::peak(device.output), 0.01F);
    device.voice().channels.panic();
    device.renderBlock();
    const std::size_t after = device.output.size();
    device.publish(landing(0.5F, impact, 1));
    renderBlocks(device, 10);
    EXPECT_EQ(testing::peak(from(device, after)), 0.0F);
    device.publish(landing(0.5F, impact, 2));
    renderBlocks(device, 2);
    EXPECT_GT(testing::peak(from(device, after)), 0.01F);
}

TEST_F(VoiceEffectsTest, OnARoundedRimTheEdgeUsesTheSpeedBeforeIt) {
    // On the rim, the normal points along the motion for a few states, so the speed along the surface is zero.
    const auto peakAt = [this](float speedMps, bool leaves) {
        SimulatedDevice device(model_, tone_);
        device.run(0.2, [speedMps](double) {
            ContactState state = testing::sliding(speedMps);
            state.effects = edge;
            return state;
        });
        ContactState onTheRim = testing::sliding(0.0F);
        onTheRim.effects = edge;
        onTheRim.edgeHeightMetres = 0.001F;
        for (int frame = 0; frame < 3; ++frame) {
            onTheRim.edgeCounter = leaves || frame < 2 ? 0 : 1;
            device.publish(onTheRim);
        }
        const std::size_t off = device.output.size();
        device.run(0.3, [&](double) {
            ContactState state = leaves ? testing::lifted(1) : onTheRim;
            state.edgeCounter = 1;
            state.edgeHeightMetres = 0.001F;
            return state;
        });
        return static_cast<double>(testing::peak(from(device, off)));
    };
    for (const bool leaves : {false, true}) {
        EXPECT_GT(peakAt(0.2F, leaves), 0.0) << leaves;
        EXPECT_NEAR(peakAt(0.4F, leaves) / peakAt(0.2F, leaves), 2.0, 0.05) << leaves;
        EXPECT_EQ(peakAt(0.0F, leaves), 0.0) << leaves;
    }
}

/// Inverts the signal and counts its instances.
class Inverter final : public effects::Effect {
public:
    explicit Inverter(int& alive, float gain = -1.0F) : alive_(alive), gain_(gain) { ++alive_; }
    ~Inverter() override { --alive_; }
    void process(std::span<float> samples) noexcept override {
        std::ranges::transform(samples, samples.begin(), [this](float sample) { return gain_ * sample; });
    }
    void reset() noexcept override {}
    [[nodiscard]] bool isIdle() const noexcept override { return true; }

private:
    int& alive_;
    float gain_;
};

class ProcessorsTest : public VoiceEffectsTest {
protected:
    void offer(SimulatedDevice& device, float gain, double rateHz = 48000.0) {
        auto fresh = std::make_unique<Processors>();
        fresh->version = ++version_;
        fresh->rateHz = rateHz;
        if (gain != 0.0F) {
            fresh->compensation = std::make_unique<Inverter>(alive_, gain);
        }
        device.voice().channels.processors.offer(std::move(fresh));
    }
    static void collect(SimulatedDevice& device) { device.voice().channels.processors.collect(); }

    int alive_ = 0;
    std::uint64_t version_ = 0;
};

TEST_F(ProcessorsTest, ProcessorsAreSwitchedOnAndOffWithoutAClick) {
    SimulatedDevice device(model_, tone_);
    device.run(0.3, slide);
    const float tone = testing::largestStep(device.output);
    for (const float gain : {-1.0F, 0.5F, -1.0F, 0.0F}) {
        offer(device, gain);
        device.run(0.1, slide);
        collect(device);
        device.run(0.1, slide);
        collect(device);
    }
    EXPECT_LT(testing::largestStep(device.output), 1.3F * tone);
    EXPECT_EQ(alive_, 0);
    EXPECT_EQ(of(device, EffectKind::compensation).prepared, 3U);
    const std::uint64_t runs = of(device, EffectKind::compensation).runs;
    EXPECT_GT(runs, 100U);
    device.run(0.3, slide);
    EXPECT_EQ(of(device, EffectKind::compensation).runs, runs) << "a processor that is switched off must not run";
}

/// Changes the processors like LiveEngine::changeProcessors.
void ask(SimulatedDevice& device, const std::function<void(ProcessorSettings&)>& change) {
    VoiceChannels& channels = device.voice().channels;
    change(channels.processorSettings);
    channels.requestedProcessors = ++channels.processorSettings.version;
    channels.lacksProcessors = true;
    device.voice().planner.serveOutputRate();
}

TEST_F(ProcessorsTest, ADelayDelaysAnImpactByExactSamples) {
    SimulatedDevice direct(model_, tone_);
    SimulatedDevice delayed(model_, tone_);
    delayed.controls().delaySeconds = 0.05;
    ask(delayed, [](ProcessorSettings& settings) { settings.hasDelay = true; });
    delayed.renderBlock();
    direct.renderBlock();
    for (SimulatedDevice* device : {&direct, &delayed}) {
        for (int block = 0; block < 20; ++block) {
            device->publish(landing(0.3F, impact));
            device->renderBlock();
        }
    }
    constexpr std::size_t later = 2400;
    // The crossfade has ended by then.
    for (std::size_t i = 512; i + later < direct.output.size(); ++i) {
        ASSERT_FLOAT_EQ(delayed.output[i + later], direct.output[i]) << i;
    }
}

TEST_F(ProcessorsTest, ProcessorChangesAtAnyTimeDoNotClick) {
    std::mt19937 random(11);
    SimulatedDevice device(model_, tone_);
    const auto profile =
        std::make_shared<const effects::ActuatorProfile>(*effects::ActuatorProfile::builtIn("voice-coil"));
    device.run(0.5, slide);
    const float tone = testing::largestStep(device.output);
    for (int change = 0; change < 150; ++change) {
        const auto draw = static_cast<std::uint32_t>(random());
        device.controls().delaySeconds = static_cast<double>(draw % 500) * 0.001;
        ask(device, [&](ProcessorSettings& settings) {
            settings.hasDelay = (draw >> 10) % 2 == 0;
            settings.hasExposureGuard = (draw >> 11) % 2 == 0;
            settings.actuator = (draw >> 12) % 2 == 0 ? profile : nullptr;
        });
        device.run(0.003 * static_cast<double>((draw >> 16) % 20), slide);
    }
    EXPECT_LT(testing::largestStep(device.output), 4.2F * tone) << "a boost of 12 dB is a factor of 4";
    for (const EffectKind kind : {EffectKind::delay, EffectKind::compensation, EffectKind::exposureGuard}) {
        EXPECT_GT(of(device, kind).prepared, 20U);
        EXPECT_GT(of(device, kind).runs, 100U);
    }
}

TEST_F(ProcessorsTest, AVoiceForWhichNoneWasSetGetsNone) {
    SimulatedDevice device(model_, tone_);
    device.run(0.1, slide);
    device.voice().channels.lacksProcessors = true;
    device.voice().planner.serveOutputRate();
    device.run(0.1, slide);
    EXPECT_EQ(of(device, EffectKind::compensation).prepared, 0U);
}

TEST_F(ProcessorsTest, MutePausePanicMissingStatesCeilingAndAnEndedWorkerActAfterTheDelay) {
    struct Stop {
        const char* name;
        std::function<void(SimulatedDevice&)> begin;
        bool isPublished = true;
        double afterSeconds = 0.0;
        bool isInferring = false;
    };
    const Stop stops[] = {
        {"mute", [](SimulatedDevice& device) { device.controls().muted = true; }},
        {"pause", [](SimulatedDevice& device) { device.controls().paused = true; }},
        {"ceiling", [](SimulatedDevice& device) { device.controls().ceiling = 0.0F; }, true, 0.0, true},
        {"panic", [](SimulatedDevice& device) { device.voice().channels.panic(); }},
        {"ended worker", [](SimulatedDevice& device) { device.workerAlive = false; }},
        {"missing states", [](SimulatedDevice&) {}, false, Staleness::minimumSeconds + 1.0 / 72.0},
    };
    for (const Stop& stop : stops) {
        SimulatedDevice device(model_, tone_);
        device.controls().delaySeconds = 0.4;
        ask(device, [](ProcessorSettings& settings) { settings.hasDelay = true; });
        device.run(1.0, slide);
        ASSERT_GT(testing::peak(from(device, device.output.size() - 480)), 0.1F / 60.0F);
        stop.begin(device);
        const std::size_t begin = device.output.size();
        const auto hand = [&](double) { return stop.isPublished ? slide(0.0) : std::nullopt; };
        device.run(0.5, hand);
        const std::uint64_t inferences = device.counters().inferences;
        device.run(0.5, hand);
        // The block in which it is noticed, and 5 ms.
        const auto until = static_cast<std::size_t>(stop.afterSeconds * 48000.0) + 256 + 240;
        EXPECT_EQ(testing::peak(from(device, begin + until)), 0.0F) << stop.name;
        EXPECT_EQ(device.counters().inferences > inferences, stop.isInferring) << stop.name;
    }
}

TEST_F(ProcessorsTest, TheGuardMeasuresTheLevelAfterTheStrength) {
    const auto shortTermAt = [this](float strength) {
        SimulatedDevice device(model_, tone_);
        device.controls().strength = strength;
        ask(device, [](ProcessorSettings& settings) { settings.hasExposureGuard = true; });
        device.run(0.5, slide);
        return device.voice().channels.exposureShortTermMps2.load();
    };
    EXPECT_GT(shortTermAt(1.0F), 0.0);
    EXPECT_NEAR(shortTermAt(0.25F) / shortTermAt(1.0F), 0.25, 0.01);
    EXPECT_EQ(shortTermAt(0.0F), 0.0);
}

TEST_F(ProcessorsTest, AGuardSwitchedOffAndOnRemembersTheDay) {
    for (const double awaySeconds : {0.2, 20.0}) {
        for (const bool changesRate : {false, true}) {
            SimulatedDevice device(model_, tone_);
            device.controls().actuatorGain = 1000.0;
            ask(device, [](ProcessorSettings& settings) { settings.hasExposureGuard = true; });
            device.run(40.0, slide);
            const engine::VoiceChannels& channels = device.voice().channels;
            const double before = channels.exposureGain;
            const double daily = channels.exposureDailyMps2;
            ASSERT_LT(before, 0.2);
            ask(device, [](ProcessorSettings& settings) { settings.hasExposureGuard = false; });
            device.run(0.5 * awaySeconds, slide);
            EXPECT_EQ(channels.exposureGain, 1.0);
            if (changesRate) {
                device.setRate(44100.0);
            }
            device.run(0.5 * awaySeconds, slide);
            ask(device, [](ProcessorSettings& settings) { settings.hasExposureGuard = true; });
            device.output.clear();
            device.run(0.05, slide);
            EXPECT_LT(20.0 * std::log10(channels.exposureGain / before), 0.5) << awaySeconds << ", " << changesRate;
            EXPECT_GE(channels.exposureDailyMps2, daily) << "what sounded meanwhile reached the hand";
            EXPECT_LT(testing::largestStep(device.output), 0.02F) << "no click";
        }
    }
}

TEST_F(ProcessorsTest, AfterARateChangeTheProcessorsApplyFromTheFirstSound) {
    SimulatedDevice device(model_, tone_);
    ask(device, [](ProcessorSettings& settings) { settings.hasExposureGuard = true; });
    device.run(0.5, slide);
    const double before = device.voice().channels.exposureDailyMps2;
    EXPECT_GT(before, 0.0);
    device.setRate(24000.0);
    device.run(0.3, slide);
    EXPECT_GE(device.voice().channels.exposureDailyMps2, before) << "the exposure of the same hand continues";
    const std::uint64_t runs = of(device, EffectKind::exposureGuard).runs;
    device.run(0.1, slide);
    EXPECT_GT(of(device, EffectKind::exposureGuard).runs, runs);
}

TEST_F(ProcessorsTest, LiftOffActsBeforeTheDelay) {
    SimulatedDevice device(model_, tone_);
    device.controls().delaySeconds = 0.2;
    ask(device, [](ProcessorSettings& settings) { settings.hasDelay = true; });
    device.run(0.6, slide);
    const std::size_t lifted = device.output.size();
    device.run(0.3, [](double) { return testing::lifted(1); });
    EXPECT_GT(testing::peak(from(device, lifted + 9000)), 0.5F / 60.0F) << "the delayed texture must still sound";
    EXPECT_LT(testing::peak(from(device, lifted + 9600 + 240 + 512)), silence);
}

}  // namespace
}  // namespace haptoflow::engine
