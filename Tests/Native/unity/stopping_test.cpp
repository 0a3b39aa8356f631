#include "stepped_voice.hpp"

#include <gmock/gmock.h>

#include <span>

namespace haptoflow::unity::testing {
namespace {

using ::testing::Each;

constexpr std::size_t stopFrames = 240;

/// The effect on the second of two channels, with a voice that is already sliding.
class StoppingTest : public VoiceEffectTest {
protected:
    StoppingTest() {
        effect.set("Channel", 1.0F);
        const std::vector<float> output = play(voice_, effect, 10).channel(1);
        // Other stretches of the texture have larger steps.
        usualStep = 1.5F * largestStepFrom(0.0F, output);
        last = output.back();
        EXPECT_GT(usualStep, 1e-4F);
    }

    [[nodiscard]] std::uint64_t rendered() const { return voice_.statistics().rendered_frames; }

    /// The step that a linear fade over `frames` frames adds to the voice's own steps.
    static float fadeStep(std::size_t frames) { return 1.0F / static_cast<float>(frames); }

    HostedEffect effect{definition()};
    float usualStep = 0.0F;
    float last = 0.0F;
};

class StoppingFlagsTest : public StoppingTest, public ::testing::WithParamInterface<std::uint32_t> {};

TEST_P(StoppingFlagsTest, TheVoiceFadesWithin5MsAndIsThenNotRendered) {
    SteppedVoice same(runtime_, model_);
    (void)reference(same, 10);
    const std::uint64_t before = rendered();
    effect.setFlags(GetParam());
    voice_.slide();
    const std::vector<float> output = effect.process(frameOfAudio).channel(1);
    const std::vector<float> whole = reference(same, 1);
    for (std::size_t i = 0; i < stopFrames; ++i) {
        ASSERT_NEAR(output[i], whole[i] * (1.0F - static_cast<float>(i + 1) / stopFrames), 1e-6F) << i;
    }
    EXPECT_THAT(std::span(output).subspan(stopFrames), Each(0.0F));
    voice_.slide();
    EXPECT_THAT(effect.process(frameOfAudio).channel(1), Each(0.0F)) << "the next block";
    EXPECT_EQ(rendered(), before + stopFrames);
}

TEST_P(StoppingFlagsTest, AResumedEffectFadesInFromSilence) {
    effect.setFlags(GetParam());
    voice_.slide();
    (void)effect.process(frameOfAudio);
    effect.setFlags(flagPlaying);
    const std::vector<float> output = play(voice_, effect, 4).channel(1);
    EXPECT_LE(largestStepFrom(0.0F, output), usualStep + fadeStep(frameOfAudio) * peak(output) + 1e-6F);
    EXPECT_GT(peak(output), 1e-3F);
}

INSTANTIATE_TEST_SUITE_P(Flags, StoppingFlagsTest,
                         ::testing::Values(flagPlaying | flagPaused, flagPlaying | flagMuted, 0U),
                         [](const auto& flags) {
                             switch (flags.param) {
                                 case flagPlaying | flagPaused:
                                     return "paused";
                                 case flagPlaying | flagMuted:
                                     return "muted";
                                 default:
                                     return "notPlaying";
                             }
                         });

TEST_F(StoppingTest, ASuspendedGroupResumesFromSilence) {
    for (int i = 0; i < 3; ++i) {
        effect.suspend(30 * frameOfAudio + 17);
        const std::uint64_t before = rendered();
        const std::vector<float> output = play(voice_, effect, 4).channel(1);
        EXPECT_LE(largestStepFrom(0.0F, output), usualStep + fadeStep(frameOfAudio) * peak(output) + 1e-6F);
        EXPECT_GT(peak(output), 1e-3F);
        EXPECT_EQ(rendered(), before + 4 * frameOfAudio);
    }
}

TEST_F(StoppingTest, TicksThatDoNotCountSamplesAreNotTreatedAsSuspension) {
    SteppedVoice same(runtime_, model_);
    (void)reference(same, 10);
    effect.reset();
    for (std::size_t i = 0; i < 10; ++i) {
        effect.suspend(3 * i + 1);
        voice_.slide();
        const std::vector<float> output = effect.process(frameOfAudio).channel(1);
        voice_.generate();
        ASSERT_EQ(output, reference(same, 1)) << i;
    }
}

TEST_F(StoppingTest, AfterAResetTheNextBlockHasFullStrength) {
    SteppedVoice same(runtime_, model_);
    (void)reference(same, 10);
    effect.set("Strength", 0.5F);
    effect.reset();
    std::vector<float> expected = reference(same, 1);
    for (float& sample : expected) {
        sample *= 0.5F;
    }
    EXPECT_EQ(play(voice_, effect, 1).channel(1), expected);
}

TEST_F(StoppingTest, AChangeOfChannelFadesOutAndIn) {
    effect.set("Channel", 0.0F);
    voice_.slide();
    const Sound in = Sound::pattern(frameOfAudio, 2);
    const Sound output = effect.process(in, 2);
    for (std::size_t i = 0; i < frameOfAudio; ++i) {
        const std::size_t passing = i < stopFrames ? 0 : 1;
        ASSERT_EQ(output.samples[2 * i + passing], in.samples[2 * i + passing]) << i;
    }
    const std::vector<float> left = output.channel(0);
    const std::vector<float> right = output.channel(1);
    const float margin = usualStep + fadeStep(stopFrames) * peak(right) + 1e-6F;
    EXPECT_LE(largestStepFrom(last, std::span(right).first(stopFrames)), margin);
    EXPECT_EQ(right[stopFrames - 1], 0.0F);
    EXPECT_LE(largestStepFrom(0.0F, std::span(left).subspan(stopFrames)), usualStep + margin);
    EXPECT_GT(peak(std::span(left).subspan(stopFrames)), 1e-4F);
}

TEST_F(StoppingTest, AChangeOfVoicePassesThroughSilence) {
    SteppedVoice other(runtime_, model_);
    effect.set("Voice", other.place());
    voice_.slide();
    other.slide();
    const std::uint64_t before = rendered();
    const std::vector<float> output = effect.process(frameOfAudio).channel(1);
    EXPECT_EQ(output[stopFrames - 1], 0.0F);
    EXPECT_EQ(rendered(), before + stopFrames);
    EXPECT_EQ(other.statistics().rendered_frames, frameOfAudio - stopFrames);
}

TEST_P(StoppingFlagsTest, AnEffectThatStartsSilentDoesNotRenderTheVoice) {
    effect.reset();
    effect.setFlags(GetParam());
    const std::uint64_t before = rendered();
    EXPECT_THAT(effect.process(frameOfAudio).channel(1), Each(0.0F));
    EXPECT_EQ(rendered(), before);
}

TEST_F(StoppingTest, ATouchWithoutNewStatesSinceThePauseBecomesStale) {
    effect.setFlags(flagPlaying | flagPaused);
    for (int i = 0; i < 50; ++i) {
        (void)effect.process(frameOfAudio);
    }
    EXPECT_EQ(voice_.statistics().stale_stops, 0U);
    effect.setFlags(flagPlaying);
    for (int i = 0; i < 11; ++i) {
        (void)effect.process(frameOfAudio);
    }
    EXPECT_EQ(voice_.statistics().stale_stops, 1U);
    EXPECT_THAT(effect.process(frameOfAudio).channel(1), Each(0.0F));
}

}  // namespace
}  // namespace haptoflow::unity::testing
