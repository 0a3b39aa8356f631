#include "stepped_voice.hpp"

#include <gmock/gmock.h>

#include <array>
#include <list>
#include <optional>

namespace haptoflow::unity::testing {
namespace {

using ::testing::Each;

using RoutingTest = VoiceEffectTest;

TEST_F(RoutingTest, TheRoutedChannelCarriesTheVoiceAndTheOtherItsInput) {
    SteppedVoice same(runtime_, model_);
    HostedEffect effect(definition());
    effect.set("Voice", voice_.place());
    effect.set("Channel", 1.0F);
    for (int i = 0; i < 20; ++i) {
        voice_.slide();
        same.slide();
        Sound expected = Sound::pattern(frameOfAudio, 2);
        const Sound output = effect.process(expected, 2);
        same.renderInto(expected, 1);
        ASSERT_EQ(output.samples, expected.samples) << i;
        EXPECT_GT(peak(output.channel(1)), 1e-3F) << i;
        voice_.generate();
        same.generate();
    }
    EXPECT_GT(voice_.statistics().inferences, 15U);
}

TEST_F(RoutingTest, ABlockOfAnyLengthIsFilled) {
    SteppedVoice same(runtime_, model_);
    HostedEffect effect(definition());
    effect.set("Channel", 0.0F);
    voice_.slide();
    same.slide();
    Sound expected = Sound::pattern(20000, 2);
    const Sound output = effect.process(expected, 2);
    same.renderInto(expected, 0);
    EXPECT_EQ(output.samples, expected.samples);
    EXPECT_GT(peak(output.channel(0)), 1e-3F);
    EXPECT_EQ(voice_.statistics().rendered_frames, 20000U);
}

TEST_F(RoutingTest, AnEmptyPlaceSilencesOnlyTheRoutedChannel) {
    HostedEffect effect(definition());
    effect.set("Voice", 40.0F);
    effect.set("Channel", 0.0F);
    const Sound in = Sound::pattern(256, 2);
    const Sound output = effect.process(in, 2);
    EXPECT_THAT(output.channel(0), Each(0.0F));
    EXPECT_EQ(output.channel(1), in.channel(1));
    EXPECT_EQ(voice_.statistics().rendered_frames, 0U);
}

TEST_F(RoutingTest, AMissingChannelPlaysNothingAndRendersNothing) {
    HostedEffect effect(definition());
    effect.set("Channel", 5.0F);
    voice_.slide();
    const Sound in = Sound::pattern(256, 2);
    EXPECT_EQ(effect.process(in, 2).samples, in.samples);
    EXPECT_EQ(voice_.statistics().rendered_frames, 0U);
}

TEST_F(RoutingTest, OnlyOneTo64ChannelsCarryAVoice) {
    HostedEffect effect(definition());
    const Sound in = Sound::pattern(16, 65);
    EXPECT_EQ(effect.process(in, 65).samples, in.samples);
    EXPECT_EQ(effect.definition().process(&effect.state(), nullptr, nullptr, 16, 2, 0), resultUnsupported);
    EXPECT_EQ(effect.definition().process(&effect.state(), nullptr, nullptr, 16, 2, -2), resultUnsupported);
    EXPECT_EQ(effect.definition().process(&effect.state(), nullptr, nullptr, 16, 2, 2), resultUnsupported);
    EXPECT_EQ(voice_.statistics().rendered_frames, 0U);
}

struct ChannelCounts {
    std::size_t in;
    std::size_t out;
};

constexpr auto channelCounts =
    std::to_array<ChannelCounts>({{0, 2}, {1, 1}, {1, 2}, {2, 1}, {2, 2}, {2, 8}, {6, 2}, {8, 8}});

TEST(ChannelCountsTest, ChannelsPassByIndexEvenInPlace) {
    const UnityHost host;
    for (const auto [inChannels, outChannels] : channelCounts) {
        HostedEffect effect(host.effect("HaptoFlow Voice"));
        const ::testing::ScopedTrace trace(__FILE__, __LINE__, inChannels * 10 + outChannels);
        const Sound in = Sound::pattern(100, inChannels);
        const std::size_t routed = outChannels - 1;
        effect.set("Channel", static_cast<float>(routed));
        for (const Sound& output : {effect.process(in, outChannels), effect.processInPlace(in, outChannels)}) {
            for (std::size_t channel = 0; channel < routed; ++channel) {
                const auto expected = channel < inChannels ? in.channel(channel) : std::vector<float>(100);
                EXPECT_EQ(output.channel(channel), expected) << channel;
            }
            EXPECT_THAT(output.channel(routed), Each(0.0F));
        }
    }
}

TEST_F(RoutingTest, AMissingInputBufferCountsAsSilence) {
    HostedEffect effect(definition());
    effect.set("Channel", 0.0F);
    Sound out = Sound::pattern(32, 2);
    EXPECT_EQ(effect.definition().process(&effect.state(), nullptr, out.samples.data(), 32, 2, 2), resultOk);
    EXPECT_THAT(out.samples, Each(0.0F));
}

TEST_F(RoutingTest, TheStrengthChangesLinearlyWithin10Ms) {
    SteppedVoice same(runtime_, model_);
    HostedEffect effect(definition());
    (void)play(voice_, effect, 5);
    (void)reference(same, 5);
    effect.set("Strength", 0.25F);
    const std::vector<float> output = play(voice_, effect, 2).channel(0);
    const std::vector<float> whole = reference(same, 2);
    for (std::size_t i = 0; i < output.size(); ++i) {
        const float gain = i < 480 ? 1.0F - 0.75F * static_cast<float>(i + 1) / 480.0F : 0.25F;
        ASSERT_NEAR(output[i], gain * whole[i], 1e-6F) << i;
    }
}

using SeveralEffectsTest = VoiceEffectTest;

TEST_F(SeveralEffectsTest, EachEffectPlaysItsOwnVoice) {
    SteppedVoice second(runtime_, model_);
    SteppedVoice same(runtime_, model_);
    HostedEffect left(definition());
    HostedEffect right(definition());
    left.set("Voice", voice_.place());
    right.set("Voice", second.place());
    for (int i = 0; i < 8; ++i) {
        const std::vector<float> expected = reference(same, 1);
        EXPECT_EQ(play(voice_, left, 1).channel(0), expected);
        EXPECT_EQ(play(second, right, 1).channel(0), expected);
    }
}

TEST_F(SeveralEffectsTest, TheSecondEffectTakesOverWhenTheFirstGivesTheVoiceBack) {
    using First = std::optional<HostedEffect>;
    struct Reason {
        const char* name;
        void (*happen)(First& first);
        std::size_t channelsAfter = 2;
    };
    const auto reasons = std::to_array<Reason>({
        {"released", [](First& first) { first.reset(); }},
        {"paused", [](First& first) { first->setFlags(flagPlaying | flagPaused); }},
        {"another voice", [](First& first) { first->set("Voice", 40.0F); }},
        {"a channel that is not there", [](First& first) { first->set("Channel", 6.0F); }},
        {"an output that lost the channel", [](First&) {}, 1},
    });
    HostedEffect second(definition());
    for (const Reason& reason : reasons) {
        First first(std::in_place, definition());
        first->set("Channel", 1.0F);
        (void)play(voice_, *first, 2);
        EXPECT_THAT(second.process(frameOfAudio).channel(0), Each(0.0F)) << reason.name;
        reason.happen(first);
        if (first) {
            (void)play(voice_, *first, 1, reason.channelsAfter);
        }
        const std::vector<float> played = play(voice_, second, 2).channel(0);
        EXPECT_GT(peak(played), 1e-3F) << reason.name;
        EXPECT_LT(std::abs(played.front()), 1e-3F) << "it must fade in from silence: " << reason.name;
        // Prepares the next case.
        second.set("Voice", 41.0F);
        (void)second.process(frameOfAudio);
        second.set("Voice", 0.0F);
    }
}

TEST_F(SeveralEffectsTest, TheSecondEffectTakesOver100MsAfterTheLastCallOfTheFirst) {
    HostedEffect first(definition());
    HostedEffect second(definition());
    (void)play(voice_, first, 3);
    // In the first of these blocks, the second effect only reads the claim of the first.
    EXPECT_THAT(play(voice_, second, 10).channel(0), Each(0.0F));
    EXPECT_GT(peak(play(voice_, second, 3).channel(0)), 1e-3F);
    EXPECT_THAT(play(voice_, first, 1).channel(0), Each(0.0F)) << "the second effect now has the voice";
}

TEST_F(SeveralEffectsTest, AClosedVoiceFadesAndTheNextVoiceAtItsPlaceSounds) {
    HostedEffect effect(definition());
    std::optional<SteppedVoice> second(std::in_place, runtime_, model_);
    const float place = second->place();
    effect.set("Voice", place);
    std::vector<float> output = play(*second, effect, 3).channel(0);
    const float usualStep = largestStep(output);
    second->close();
    const std::vector<float> end = effect.process(frameOfAudio).channel(0);
    EXPECT_LE(largestStepFrom(output.back(), end), usualStep) << "the effect plays the fade";
    EXPECT_GT(peak(end), 1e-3F);
    EXPECT_THAT(effect.process(frameOfAudio).samples, Each(0.0F));
    // Voices of the test before may have left lower places meanwhile.
    std::list<SteppedVoice> lower;
    for (second.emplace(runtime_, model_); second->place() != place && lower.size() < 8;) {
        second.reset();
        lower.emplace_back(runtime_, model_);
        second.emplace(runtime_, model_);
    }
    ASSERT_EQ(second->place(), place);
    SteppedVoice same(runtime_, model_);
    EXPECT_EQ(play(*second, effect, 5).channel(0), reference(same, 5))
        << "no ramp is needed, because a voice starts with silence";
}

}  // namespace
}  // namespace haptoflow::unity::testing
