#include "stepped_voice.hpp"

#include <gmock/gmock.h>

#include <array>
#include <optional>

namespace haptoflow::unity::testing {
namespace {

using ::testing::Each;

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
    second.emplace(runtime_, model_);
    ASSERT_EQ(second->place(), place);
    SteppedVoice same(runtime_, model_);
    EXPECT_EQ(play(*second, effect, 5).channel(0), reference(same, 5))
        << "no ramp is needed, because a voice starts with silence";
}

}  // namespace
}  // namespace haptoflow::unity::testing
