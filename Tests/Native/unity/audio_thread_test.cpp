#include "allocation_counter.hpp"
#include "stepped_voice.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <thread>

namespace haptoflow::unity::testing {
namespace {

using AudioThreadTest = VoiceEffectTest;

bool isWithinFullScale(const Sound& sound) {
    return std::ranges::all_of(sound.samples, [](float sample) { return std::abs(sample) <= 1.0F; });
}

TEST_F(AudioThreadTest, ProcessingNeverAllocates) {
    HostedEffect effect(definition());
    const AudioEffectDefinition& callbacks = definition();
    AudioEffectState& state = effect.state();
    std::vector<float> in(20000, 0.1F);
    std::vector<float> out(20000);
    std::size_t calls = 0;
    for (int i = 0; i < 40; ++i) {
        voice_.slide();
        const std::uint32_t frames = i % 10 == 9 ? 10000 : 256;
        effect.setFlags(i % 8 == 5 ? flagPlaying | flagPaused : flagPlaying);
        effect.setSampleRate(i < 30 ? 48000 : 24000);
        if (i % 6 == 0) {
            effect.suspend(5000);
        }
        {
            const AllocationCounter counter;
            callbacks.setParameter(&state, 0, i % 2 == 0 ? 0.4F : 1.0F);
            callbacks.setParameter(&state, 1, i % 9 == 7 ? 40.0F : 0.0F);
            callbacks.setParameter(&state, 2, static_cast<float>(i % 4) - 1.0F);
            if (i % 13 == 12) {
                callbacks.reset(&state);
            }
            callbacks.process(&state, in.data(), out.data(), frames, 2, 2);
            std::array<char, 16> text{};
            callbacks.getParameter(&state, i % 3, nullptr, text.data());
            calls += counter.calls();
        }
        voice_.generate();
    }
    EXPECT_EQ(calls, 0U);
    EXPECT_GT(voice_.statistics().inferences, 5U);

    const AllocationCounter counter;
    const auto proof = std::make_unique<std::vector<float>>(10);
    EXPECT_GT(counter.calls(), 0U) << "the counter does not count";
}

TEST_F(AudioThreadTest, AllocationsInsideTheLibraryAreCounted) {
    AudioEffectState state{};
    state.structSize = sizeof(state);
    const AllocationCounter counter;
    ASSERT_EQ(definition().create(&state), resultOk);
    EXPECT_GT(counter.calls(), 0U);
    EXPECT_EQ(definition().release(&state), resultOk);
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
