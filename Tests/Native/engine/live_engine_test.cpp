// Tests with real threads: the worker, and publishers and audio callbacks of several voices.
#include "engine/live_engine.hpp"

#include "fake_generators.hpp"
#include "inference/load_limits.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <thread>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;

class LiveEngineTest : public ::testing::Test {
protected:
    [[nodiscard]] LiveEngineSettings settings(bool hasWorker) const {
        LiveEngineSettings settings;
        settings.quality.fixedTier = 0;
        settings.hasWorker = hasWorker;
        return settings;
    }

    [[nodiscard]] std::unique_ptr<LiveEngine> engine(const LiveEngineSettings& settings, int tiers = 1) const {
        EngineTiers ready;
        for (int tier = 0; tier < tiers; ++tier) {
            ready.push_back(std::make_unique<FakeGenerator>(testing::continueTone));
        }
        return std::make_unique<LiveEngine>(model_, std::move(ready), 0, settings);
    }

    /// An engine of one tier without a worker.
    template <typename Generator>
    [[nodiscard]] std::unique_ptr<LiveEngine> engineOf(std::unique_ptr<Generator> generator,
                                                       bool hasWorker = false) const {
        EngineTiers tiers;
        tiers.push_back(std::move(generator));
        return std::make_unique<LiveEngine>(model_, std::move(tiers), 0, settings(hasWorker));
    }

    /// Renders until the condition holds, for at most about ten seconds of wall time.
    template <typename Condition>
    static bool renderUntil(LiveVoice& voice, Condition condition) {
        std::vector<float> block(256);
        for (int i = 0; i < 10000 && !condition(); ++i) {
            voice.renderer.render(block, 48000.0);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return condition();
    }

    std::shared_ptr<const model::ModelFile> model_ = std::make_shared<const model::ModelFile>(testing::smallModel());
};

TEST_F(LiveEngineTest, AStepGeneratesForAllTouchingVoicesInOneBatch) {
    auto generator = std::make_unique<FakeGenerator>(testing::continueTone);
    FakeGenerator& seen = *generator;
    const auto engine = engineOf(std::move(generator));
    std::vector<std::shared_ptr<LiveVoice>> voices;
    for (int i = 0; i < 5; ++i) {
        voices.push_back(engine->addVoice(48000.0));
    }
    std::vector<float> block(256);
    for (int update = 0; update < 10; ++update) {
        for (std::size_t i = 0; i < voices.size(); ++i) {
            engine->publish(*voices[i], i < 3 ? testing::sliding() : testing::lifted(0));
        }
        for (const auto& voice : voices) {
            for (int blocks = 0; blocks < 3; ++blocks) {
                voice->renderer.render(block, 48000.0);
            }
        }
        const RoundResult result = engine->step();
        EXPECT_EQ(result.voices, 3U);
    }
    EXPECT_EQ(seen.rounds, 10);
    EXPECT_EQ(seen.generated, 30);
    EXPECT_EQ(voices[4]->channels.counters.inferences, 0U);
    EXPECT_EQ(engine->statistics().segments, 30U);
}

TEST_F(LiveEngineTest, WithoutTouchesTheWorkerSleepsAndInfersNothing) {
    const auto engine = this->engine(settings(true));
    const auto voice = engine->addVoice(48000.0);
    const std::uint64_t wakes = engine->statistics().wakes;
    std::vector<float> block(256);
    for (int update = 0; update < 500; ++update) {
        engine->publish(*voice, testing::lifted(0));
        voice->renderer.render(block, 48000.0);
    }
    EXPECT_EQ(engine->statistics().wakes, wakes);
    EXPECT_EQ(engine->statistics().rounds, 0U);
}

TEST_F(LiveEngineTest, TheWorkerGeneratesForATouchAndTheVoiceFallsSilentWithoutIt) {
    const auto engine = this->engine(settings(true));
    const auto voice = engine->addVoice(48000.0);
    const VoiceCounters& counters = voice->channels.counters;
    EXPECT_TRUE(renderUntil(*voice, [&] {
        engine->publish(*voice, testing::sliding());
        return counters.inferences >= 20;
    }));
    engine->stop();
    std::vector<float> block(256);
    voice->renderer.render(block, 48000.0);
    voice->renderer.render(block, 48000.0);
    engine->publish(*voice, testing::sliding());
    voice->renderer.render(block, 48000.0);
    EXPECT_EQ(testing::peak(block), 0.0F) << "the worker has ended";
    engine->removeVoice(*voice);
}

TEST_F(LiveEngineTest, ManyConcurrentVoicesPublishersAndCallbacksKeepEveryWaveIntact) {
    const auto engine = this->engine(settings(true));
    constexpr int count = 4;
    std::atomic<bool> done{false};
    std::vector<std::shared_ptr<LiveVoice>> voices;
    std::vector<std::thread> threads;
    std::array<std::atomic<float>, count> peaks{};
    for (int i = 0; i < count; ++i) {
        voices.push_back(engine->addVoice(48000.0));
    }
    for (std::size_t i = 0; i < count; ++i) {
        LiveVoice& voice = *voices[i];
        threads.emplace_back([&, i] {
            std::vector<float> block(128 + 64 * i);
            while (!done) {
                voice.renderer.render(block, 48000.0);
                peaks[i] = std::max(peaks[i].load(), testing::peak(block));
                // At least a millisecond, because MinGW's threads do not sleep for shorter times.
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            }
        });
        threads.emplace_back([&, i] {
            ContactState state = testing::sliding();
            for (int update = 0; !done; ++update) {
                state.touching = update % 50 < 45;
                state.touchCounter = static_cast<std::uint32_t>(update / 50 + 1);
                state.velocityMps = {0.05F + 0.01F * static_cast<float>(i), 0.1F};
                engine->publish(voice, state);
                voice.channels.controls.muted = update % 97 == 96;
                std::this_thread::sleep_for(std::chrono::milliseconds(2));
            }
        });
    }
    threads.emplace_back([&] {
        while (!done) {
            const auto passing = engine->addVoice(44100.0);
            engine->publish(*passing, testing::sliding());
            std::this_thread::sleep_for(std::chrono::milliseconds(3));
            engine->removeVoice(*passing);
            (void)engine->statistics();
        }
    });
    const auto hasLived = [](const std::shared_ptr<LiveVoice>& voice) {
        return voice->channels.counters.inferences > 20 && voice->channels.counters.onsets > 3;
    };
    // About half a second; longer on a slow machine.
    for (int tenth = 0; tenth < 300 && (tenth < 5 || !std::ranges::all_of(voices, hasLived)); ++tenth) {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    done = true;
    for (std::thread& thread : threads) {
        thread.join();
    }
    for (std::size_t i = 0; i < count; ++i) {
        const VoiceCounters& counters = voices[i]->channels.counters;
        EXPECT_GT(counters.inferences, 20U);
        EXPECT_GT(counters.onsets, 3U);
        EXPECT_EQ(counters.nonFiniteSamples, 0U);
        EXPECT_GT(peaks[i], 0.2F / 60.0F);
        EXPECT_LT(peaks[i], 3.0F / 60.0F);
        engine->removeVoice(*voices[i]);
    }
}

TEST_F(LiveEngineTest, AutomaticQualityMeasuresEveryTierAtRestAndThenDecides) {
    LiveEngineSettings automatic = settings(true);
    automatic.quality.fixedTier.reset();
    automatic.quality.budgetMs = 1000.0;
    automatic.updateRateHz = 2000.0;
    const auto engine = this->engine(automatic, 3);
    for (int i = 0; i < 10000 && engine->statistics().measuring; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const EngineStatistics& statistics = engine->statistics();
    EXPECT_FALSE(statistics.measuring);
    EXPECT_EQ(statistics.tier, 2U);
    for (std::size_t index = 0; index < engine->tierCount(); ++index) {
        const TierTimes tier = engine->tierTimes(index);
        EXPECT_EQ(tier.runs, QualityControl::measuringRuns);
        EXPECT_GT(tier.percentile99Ms, 0.0);
    }
}

TEST_F(LiveEngineTest, AVoiceWithAStoppedDeviceDoesNotBlockOtherVoices) {
    const auto engine = this->engine(settings(true));
    const auto stoppedVoice = engine->addVoice(48000.0);
    const auto activeVoice = engine->addVoice(48000.0);
    std::vector<float> block(256);
    for (int update = 0; update < 200; ++update) {
        engine->publish(*stoppedVoice, testing::sliding());
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_EQ(stoppedVoice->channels.counters.inferences, 0U);
    // The worker reads the contact before the callback, so only a later poll can find that the onset is playing.
    engine->publish(*activeVoice, testing::sliding());
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_TRUE(renderUntil(*activeVoice, [&] { return activeVoice->channels.counters.inferences > 0; }));
}

TEST_F(LiveEngineTest, AFailureOfOneVoiceDoesNotSilenceTheOthers) {
    auto generator =
        std::make_unique<FakeGenerator>([](const inference::SegmentRequest& request, std::span<float> out) {
            if (request.motion[2] > 1.5F) {
                throw std::runtime_error("refused by the test");
            }
            testing::continueTone(request, out);
        });
    const auto engine = engineOf(std::move(generator));
    const std::array voices{engine->addVoice(48000.0), engine->addVoice(48000.0), engine->addVoice(48000.0)};
    std::vector<float> block(256);
    // For the duration of the seeds. Without a segment after it, the second voice ends there.
    for (int update = 0; update < 4; ++update) {
        for (std::size_t i = 0; i < voices.size(); ++i) {
            engine->publish(*voices[i], testing::sliding(0.1F, i == 1 ? 2.0F : 1.0F));
            for (int blocks = 0; blocks < 3; ++blocks) {
                voices[i]->renderer.render(block, 48000.0);
            }
        }
        EXPECT_TRUE(engine->step().failed);
    }
    for (const std::size_t i : {0U, 2U}) {
        EXPECT_EQ(voices[i]->channels.counters.inferences, 4U);
        EXPECT_EQ(voices[i]->channels.counters.failures, 0U);
        EXPECT_GT(voices[i]->channels.counters.inferenceNanoseconds, 0U);
    }
    EXPECT_EQ(voices[1]->channels.counters.inferences, 0U);
    EXPECT_EQ(voices[1]->channels.counters.failures, 4U);
    EXPECT_EQ(voices[1]->channels.counters.inferenceNanoseconds, 0U);
}

/// Blocks in `generate` until released, and reports that it has begun.
class HeldGenerator final : public inference::SegmentGenerator {
public:
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        isInside = true;
        while (isHeld) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        std::ranges::fill(segments.first(requests.size() * inference::segmentSamples), 0.5F);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        std::fill_n(levelsMps2.begin(), requests.size(), 1.0F);
    }

    std::atomic<bool> isHeld{true};
    std::atomic<bool> isInside{false};
};

TEST_F(LiveEngineTest, VoicesAndQualityChangeWithoutWaitingForInference) {
    auto generator = std::make_unique<HeldGenerator>();
    HeldGenerator& held = *generator;
    const auto engine = engineOf(std::move(generator), true);
    auto voice = engine->addVoice(48000.0);
    ASSERT_TRUE(renderUntil(*voice, [&] {
        engine->publish(*voice, testing::sliding());
        return held.isInside.load();
    }));
    std::atomic<bool> isDone{false};
    std::thread user([&] {
        const auto another = engine->addVoice(44100.0);
        (void)engine->statistics();
        (void)engine->tierTimes(0);
        (void)engine->lastFailure();
        engine->setQuality({.fixedTier = 0, .budgetMs = 5.0});
        engine->publish(*another, testing::sliding());
        engine->removeVoice(*another);
        // Remove the voice of the round in progress and release its memory.
        engine->removeVoice(*voice);
        voice.reset();
        isDone = true;
    });
    for (int i = 0; i < 10000 && !isDone; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_TRUE(isDone) << "a call waited for the network";
    held.isHeld = false;
    user.join();
    EXPECT_EQ(engine->statistics().voices, 0U);
}

TEST_F(LiveEngineTest, TheMessageOfTheNewestFailureIsKept) {
    auto generator = std::make_unique<FakeGenerator>([](const inference::SegmentRequest& request, std::span<float>) {
        throw inference::InferenceError("no segment for " + std::to_string(request.motion[2]) + " N");
    });
    const auto engine = engineOf(std::move(generator));
    const auto voice = engine->addVoice(48000.0);
    EXPECT_EQ(engine->lastFailure(), "");
    std::vector<float> block(256);
    for (const float newtons : {1.0F, 3.0F}) {
        engine->publish(*voice, testing::sliding(0.1F, newtons));
        voice->renderer.render(block, 48000.0);
        engine->step();
        EXPECT_EQ(engine->lastFailure(), "no segment for " + std::to_string(newtons) + " N");
        voice->renderer.render(block, 48000.0);
    }
    EXPECT_EQ(engine->statistics().failedRounds, 2U);
}

TEST_F(LiveEngineTest, SettingsOutOfRangeAreRejected) {
    const auto refused = [this](auto change) {
        LiveEngineSettings changed = settings(false);
        change(changed);
        EXPECT_THROW((void)engine(changed), std::invalid_argument);
    };
    refused([](LiveEngineSettings& bad) { bad.updateRateHz = 0.0; });
    refused([](LiveEngineSettings& bad) { bad.fixedLeadMs = 51.0; });
    refused([](LiveEngineSettings& bad) { bad.quality.budgetMs = 0.0; });
    for (const float fullScaleMps2 : {0.0F, -60.0F, 1e-4F, 2e6F, std::nanf(""), INFINITY}) {
        refused([fullScaleMps2](LiveEngineSettings& bad) { bad.fullScaleMps2 = fullScaleMps2; });
    }
    EXPECT_THROW(LiveEngine(model_, {}, 0, settings(false)), std::invalid_argument);
    EXPECT_THROW((void)engine(settings(false))->addVoice(4000.0), std::invalid_argument);
}

}  // namespace
}  // namespace haptoflow::engine
