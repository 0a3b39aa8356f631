#include "stepped_voice.hpp"

#include <algorithm>
#include <atomic>
#include <optional>
#include <thread>

namespace haptoflow::unity::testing {
namespace {

using AudioThreadTest = VoiceEffectTest;

bool isWithinFullScale(const Sound& sound) {
    return std::ranges::all_of(sound.samples, [](float sample) { return std::abs(sample) <= 1.0F; });
}

TEST_F(AudioThreadTest, ParametersCanBeSetFromAnotherThread) {
    SteppedVoice second(runtime_, model_);
    HostedEffect effect(definition());
    std::atomic<bool> isDone{false};
    std::thread mainThread([&] {
        const AudioEffectDefinition& callbacks = definition();
        for (int i = 0; !isDone.load(); ++i) {
            callbacks.setParameter(&effect.state(), 0, static_cast<float>(i % 11) * 0.1F);
            callbacks.setParameter(&effect.state(), 1, static_cast<float>(i / 7 % 3));
            callbacks.setParameter(&effect.state(), 2, static_cast<float>(i / 5 % 4 - 1));
            if (i % 101 == 0) {
                callbacks.reset(&effect.state());
            }
            std::this_thread::yield();
        }
    });
    float loudestOutput = 0.0F;
    bool isBounded = true;
    for (int i = 0; i < 400; ++i) {
        voice_.slide();
        second.slide();
        const Sound output = effect.process(128);
        loudestOutput = std::max(loudestOutput, peak(output.samples));
        isBounded = isBounded && isWithinFullScale(output);
        if (i % 4 == 0) {
            voice_.generate();
            second.generate();
        }
    }
    isDone = true;
    mainThread.join();
    EXPECT_TRUE(isBounded);
    EXPECT_GT(loudestOutput, 1e-3F);
    effect.set("Strength", 0.5F);
    EXPECT_EQ(effect.get("Strength"), 0.5F);
}

TEST_F(AudioThreadTest, VoicesCanOpenAndCloseWhileAnEffectPlays) {
    HostedEffect effect(definition());
    effect.set("Voice", voice_.place() + 1.0F);
    std::atomic<bool> isDone{false};
    bool isBounded = true;
    std::thread audioThread([&] {
        while (!isDone.load()) {
            const Sound output = effect.process(64);
            isBounded = isBounded && isWithinFullScale(output);
        }
    });
    std::uint64_t rendered = 0;
    for (int i = 0; i < 4; ++i) {
        std::optional<SteppedVoice> passing(std::in_place, runtime_, model_);
        // The voice before it keeps its place until the audio thread has faded it.
        while (passing->place() != voice_.place() + 1.0F) {
            passing.reset();
            std::this_thread::yield();
            passing.emplace(runtime_, model_);
        }
        const std::uint64_t begun = rendered;
        while (rendered == begun) {
            passing->slide();
            passing->generate();
            rendered = begun + passing->statistics().rendered_frames;
        }
    }
    isDone = true;
    audioThread.join();
    EXPECT_TRUE(isBounded);
    EXPECT_GT(rendered, 0U);
}

}  // namespace
}  // namespace haptoflow::unity::testing
