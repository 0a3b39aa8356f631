#include "open_engine.hpp"

#include <gmock/gmock.h>

#include <array>
#include <bit>
#include <chrono>
#include <cstring>
#include <functional>
#include <set>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

TEST(EngineApiTest, ATouchOnTheShippedModelSoundsInTheNextBlockAndContinuesWithGeneratedSegments) {
    OpenEngine open(defaultModelPath);
    EXPECT_EQ(peak(open.render(480)), 0.0F);
    open.publish(slidingState());
    EXPECT_GT(peak(open.render(480)), 0.001F);
    for (int update = 0; update < 40; ++update) {
        EXPECT_GT(peak(open.update(slidingState())), 0.001F);
    }
    const haptoflow_voice_statistics statistics = open.statistics();
    EXPECT_EQ(statistics.inferences, 40U);
    EXPECT_EQ(statistics.underruns, 0U);
    EXPECT_GT(statistics.inference_ms, 40 * 0.01) << "no machine is faster";
}

TEST(EngineApiTest, WithoutWorkerEqualCallsGiveEqualSamplesAndAnotherSeedGivesOthers) {
    const auto play = [](uint64_t seed) {
        return OpenEngine(tinyModelPath, false, HAPTOFLOW_QUALITY_STANDARD, seed).play(30);
    };
    const std::vector<float> first = play(7);
    EXPECT_EQ(first, play(7));
    EXPECT_NE(first, play(8));
}

TEST(EngineApiTest, TheVoiceWritesItsChannelAndLeavesTheOthersUnchanged) {
    OpenEngine open(defaultModelPath);
    open.publish(slidingState());
    std::vector<float> interleaved(std::size_t{4} * 256, 9.0F);
    ASSERT_EQ(haptoflow_voice_render(open.voice, interleaved.data(), 256, 4, 2, 48000.0), HAPTOFLOW_OK);
    float loudest = 0.0F;
    for (std::size_t i = 0; i < interleaved.size(); ++i) {
        if (i % 4 == 2) {
            loudest = std::max(loudest, std::abs(interleaved[i]));
        } else {
            ASSERT_EQ(interleaved[i], 9.0F);
        }
    }
    EXPECT_GT(loudest, 0.0F);
    EXPECT_LE(loudest, 1.0F);
    ASSERT_EQ(haptoflow_voice_render(open.voice, interleaved.data(), 256, 4, HAPTOFLOW_ALL_CHANNELS, 48000.0),
              HAPTOFLOW_OK);
    for (std::size_t frame = 0; frame < 256; ++frame) {
        ASSERT_EQ(interleaved[4 * frame], interleaved[4 * frame + 3]);
    }
}

TEST(EngineApiTest, InvalidCallbackArgumentsAreRefusedWithoutAMessage) {
    OpenEngine open(tinyModelPath);
    std::array<float, 8> samples{};
    (void)haptoflow_struct_size(nullptr, nullptr);
    const std::string before = message();
    EXPECT_EQ(haptoflow_voice_render(open.voice, nullptr, 8, 1, 0, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_render(open.voice, samples.data(), 8, 0, 0, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_render(open.voice, samples.data(), 8, 65, 0, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_render(open.voice, samples.data(), 8, 1, 1, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_render(open.voice, samples.data(), 8, 1, -2, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_render(open.voice, nullptr, 0, 1, 0, 48000.0), HAPTOFLOW_OK);
    EXPECT_EQ(message(), before);
}

TEST(EngineApiTest, AVoiceThatIsNotOpenIsRefusedEverywhereAndItsBlockIsSilent) {
    OpenEngine open(tinyModelPath);
    haptoflow_voice gone = 0;
    ASSERT_EQ(haptoflow_voice_create(open.engine, 0.0, &gone), HAPTOFLOW_OK);
    const haptoflow_voice copy = gone;
    ASSERT_EQ(haptoflow_voice_destroy(&gone), HAPTOFLOW_OK);
    EXPECT_EQ(gone, 0U);
    for (const haptoflow_voice wrong : {haptoflow_voice{0}, copy, haptoflow_voice{63}, ~haptoflow_voice{0}}) {
        haptoflow_voice handle = wrong;
        const haptoflow_contact_state state = slidingState();
        std::array<float, 4> samples{1.0F, 1.0F, 1.0F, 1.0F};
        auto statistics = sized<haptoflow_voice_statistics>();
        uint32_t place = 0;
        const std::array refused{haptoflow_voice_publish(wrong, &state),
                                 haptoflow_voice_render(wrong, samples.data(), 4, 1, 0, 48000.0),
                                 haptoflow_voice_set_strength(wrong, 1.0F),
                                 haptoflow_voice_set_ceiling(wrong, 1.0F),
                                 haptoflow_voice_set_muted(wrong, 1),
                                 haptoflow_voice_set_paused(wrong, 1),
                                 haptoflow_voice_panic(wrong),
                                 haptoflow_voice_get_statistics(wrong, &statistics),
                                 haptoflow_voice_place(wrong, &place)};
        EXPECT_THAT(refused, ::testing::Each(HAPTOFLOW_INVALID_ARGUMENT));
        EXPECT_EQ(samples, (std::array<float, 4>{}));
        EXPECT_EQ(haptoflow_voice_destroy(&handle), wrong == 0 ? HAPTOFLOW_OK : HAPTOFLOW_INVALID_ARGUMENT);
    }
}

/// The output of a voice that is removed while it sounds, in blocks of `frames` until its number is refused.
std::vector<float> outputUntilGone(OpenEngine& open, uint32_t frames, const std::function<void()>& removeVoice) {
    const haptoflow_voice voice = open.voice;
    std::vector<float> output = open.update(slidingState(), 2048);
    removeVoice();
    std::vector<float> block(frames);
    while (haptoflow_voice_render(voice, block.data(), frames, 1, 0, 48000.0) == HAPTOFLOW_OK) {
        output.insert(output.end(), block.begin(), block.end());
    }
    EXPECT_EQ(block, std::vector<float>(frames)) << "a voice that has ended writes zeros";
    return output;
}

class EndOfVoiceTest : public ::testing::TestWithParam<uint32_t> {
protected:
    void expectAFade(const std::function<void(OpenEngine&)>& remove) {
        OpenEngine open(tinyModelPath);
        const float usual = largestStep(open.update(slidingState(), 2048));
        ASSERT_GT(usual, 0.0F);
        const auto began = std::chrono::steady_clock::now();
        auto spent = began - began;
        const std::vector<float> output = outputUntilGone(open, GetParam(), [&] {
            const auto before = std::chrono::steady_clock::now();
            remove(open);
            spent = std::chrono::steady_clock::now() - before;
        });
        EXPECT_LT(spent, std::chrono::milliseconds(200)) << "nobody waits for blocks that nobody renders";
        EXPECT_EQ(output.back(), 0.0F);
        EXPECT_LE(largestStep(output), 1.5F * usual);
        const std::size_t fade = output.size() - 2048;
        EXPECT_GE(fade, 240U) << "5 ms at 48 kHz";
        EXPECT_LE(fade, 240U + 2 * GetParam());
    }
};

TEST_P(EndOfVoiceTest, AVoiceDestroyedWhileItSoundsIsHeardForItsFadeWithoutAStepAndWithoutAWait) {
    expectAFade([](OpenEngine& open) { EXPECT_EQ(haptoflow_voice_destroy(&open.voice), HAPTOFLOW_OK) << message(); });
}

TEST_P(EndOfVoiceTest, AnEngineClosedWhileItsVoiceSoundsEndsItWithoutAStepAndWithoutAWait) {
    expectAFade(
        [](OpenEngine& open) { EXPECT_EQ(haptoflow_engine_close(open.engine.out()), HAPTOFLOW_OK) << message(); });
}

INSTANTIATE_TEST_SUITE_P(BlockFrames, EndOfVoiceTest, ::testing::Values(1U, 64U, 256U, 1024U, 4096U),
                         ::testing::PrintToStringParamName());

TEST(EngineApiTest, AVoiceThatNobodyRendersEndsWithAQuarterOfASecondAndItsMemoryWithTheNextVoice) {
    OpenEngine open(tinyModelPath);
    (void)open.update(slidingState(), 2048);
    const haptoflow_voice left = open.voice;
    ASSERT_EQ(haptoflow_voice_destroy(&open.voice), HAPTOFLOW_OK);
    EXPECT_EQ(open.engineStatistics().voices, 0U);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    ASSERT_EQ(haptoflow_voice_create(open.engine, 0.0, &open.voice), HAPTOFLOW_OK);
    std::array<float, 64> samples{};
    EXPECT_EQ(haptoflow_voice_render(left, samples.data(), 64, 1, 0, 48000.0), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(EngineApiTest, SixtyFourVoicesHaveDifferentPlacesAndTheNextIsRefused) {
    OpenEngine open(tinyModelPath);
    std::vector<haptoflow_voice> voices;
    std::set<uint32_t> places;
    for (int i = 1; i < HAPTOFLOW_MAXIMUM_VOICES; ++i) {
        voices.emplace_back();
        ASSERT_EQ(haptoflow_voice_create(open.engine, 0.0, &voices.back()), HAPTOFLOW_OK) << message();
        uint32_t place = 99;
        ASSERT_EQ(haptoflow_voice_place(voices.back(), &place), HAPTOFLOW_OK);
        places.insert(place);
    }
    EXPECT_EQ(places.size(), 63U);
    EXPECT_LT(*places.rbegin(), 64U);
    haptoflow_voice tooMany = 0;
    EXPECT_EQ(haptoflow_voice_create(open.engine, 0.0, &tooMany), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(open.engineStatistics().voices, 64U);
    ASSERT_EQ(haptoflow_voice_destroy(&voices[5]), HAPTOFLOW_OK);
    EXPECT_EQ(open.engineStatistics().voices, 63U);
    EXPECT_EQ(haptoflow_voice_create(open.engine, 0.0, &voices[5]), HAPTOFLOW_OK);
}

TEST(EngineApiTest, OptionsOutOfRangeAreRefusedByName) {
    OpenEngine open(tinyModelPath);
    haptoflow_engine* engine = nullptr;
    const auto refusal = [&](auto change) {
        haptoflow_engine_options changed = engineOptions(open.runtime, open.model);
        change(changed);
        EXPECT_EQ(haptoflow_engine_create(&changed, &engine), HAPTOFLOW_INVALID_ARGUMENT);
        return message();
    };
    EXPECT_THAT(refusal([](auto& o) { o.quality = 7; }), ::testing::HasSubstr("quality"));
    EXPECT_THAT(refusal([](auto& o) { o.quality = HAPTOFLOW_QUALITY_AUTO; }), ::testing::HasSubstr("without worker"));
    EXPECT_THAT(refusal([](auto& o) { o.update_rate_hz = -1.0; }), ::testing::HasSubstr("update rate"));
    EXPECT_THAT(refusal([](auto& o) { o.budget_share = 1.5; }), ::testing::HasSubstr("budget_share"));
    EXPECT_THAT(refusal([](auto& o) { o.batch_voices = 65; }), ::testing::HasSubstr("batch_voices"));
    EXPECT_THAT(refusal([](auto& o) { o.fixed_lead_ms = 51.0; }), ::testing::HasSubstr("lead"));
    for (const double fullScaleMps2 : {-60.0, 1e-9, 1e12, std::nan(""), HUGE_VAL}) {
        EXPECT_THAT(refusal([=](auto& o) { o.full_scale_mps2 = fullScaleMps2; }),
                    ::testing::HasSubstr("full_scale_mps2"));
    }
    EXPECT_THAT(refusal([](auto& o) { o.model = nullptr; }), ::testing::HasSubstr("model"));
    EXPECT_EQ(haptoflow_voice_set_strength(open.voice, 1.5F), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_EQ(haptoflow_voice_set_ceiling(open.voice, std::nanf("")), HAPTOFLOW_INVALID_ARGUMENT);
    haptoflow_voice voice = 0;
    for (const double rateHz : {4000.0, 192001.0, -48000.0, std::nan(""), HUGE_VAL}) {
        EXPECT_EQ(haptoflow_voice_create(open.engine, rateHz, &voice), HAPTOFLOW_INVALID_ARGUMENT) << rateHz;
        EXPECT_THAT(message(), ::testing::HasSubstr("8000")) << "the message names the supported range";
    }
}

TEST(EngineApiTest, AnEngineWithoutAWorkerRefusesAutomaticQualityAndKeepsItsOwn) {
    OpenEngine open(tinyModelPath);
    EXPECT_EQ(haptoflow_engine_set_quality(open.engine, HAPTOFLOW_QUALITY_AUTO), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("auto"));
    EXPECT_GT(peak(open.update(slidingState())), 0.0F);
    EXPECT_EQ(open.engineStatistics().tier, 0U);
    EXPECT_EQ(open.engineStatistics().is_measuring, 0U);
}

TEST(EngineApiTest, AnEngineWithAWorkerRefusesSteps) {
    OpenEngine open(tinyModelPath, true);
    EXPECT_EQ(haptoflow_engine_step(open.engine), HAPTOFLOW_INVALID_ARGUMENT);
    EXPECT_THAT(message(), ::testing::HasSubstr("worker"));
}

TEST(EngineApiTest, TheTierOfAQualityIsReportedWithItsMeasuredTime) {
    OpenEngine open(tinyModelPath, false, HAPTOFLOW_QUALITY_STANDARD);
    uint32_t tiers = 0;
    ASSERT_EQ(haptoflow_model_tier_count(open.model, &tiers), HAPTOFLOW_OK);
    EXPECT_EQ(open.engineStatistics().tier, 1U);
    ASSERT_EQ(haptoflow_runtime_close(open.runtime.out()), HAPTOFLOW_OK) << "the engine outlives it: " << message();
    ASSERT_EQ(haptoflow_engine_set_quality(open.engine, HAPTOFLOW_QUALITY_DRAFT), HAPTOFLOW_OK);
    (void)open.play(5);
    EXPECT_EQ(open.engineStatistics().tier, 0U);
    auto times = sized<haptoflow_tier_times>();
    ASSERT_EQ(haptoflow_engine_tier_times(open.engine, 0, &times), HAPTOFLOW_OK);
    EXPECT_EQ(times.is_current, 1U);
    EXPECT_EQ(times.runs, 5U);
    EXPECT_GT(times.median_ms, 0.0);
    EXPECT_EQ(haptoflow_engine_tier_times(open.engine, tiers, &times), HAPTOFLOW_INVALID_ARGUMENT);
}

TEST(EngineApiTest, AQualityThatThereIsNotIsRefusedAndThePresentOneStays) {
    OpenEngine open(tinyModelPath, false, HAPTOFLOW_QUALITY_STANDARD);
    for (const haptoflow_quality quality : {-1, 3, 5}) {
        EXPECT_EQ(haptoflow_engine_set_quality(open.engine, quality), HAPTOFLOW_INVALID_ARGUMENT) << quality;
        EXPECT_THAT(message(),
                    ::testing::HasSubstr("quality is " + std::to_string(quality) + "; expected 0 (auto), 1"));
        EXPECT_EQ(open.engineStatistics().tier, 1U);
    }
}

TEST(EngineApiTest, PanicSilencesEveryVoiceOfTheProcess) {
    OpenEngine first(defaultModelPath);
    OpenEngine second(defaultModelPath);
    for (OpenEngine* open : {&first, &second}) {
        open->publish(slidingState());
        EXPECT_GT(peak(open->render(256)), 0.0F);
    }
    ASSERT_EQ(haptoflow_panic(), HAPTOFLOW_OK);
    for (OpenEngine* open : {&first, &second}) {
        (void)open->render(256);
        open->publish(slidingState());
        EXPECT_EQ(peak(open->render(4800)), 0.0F);
    }
}

TEST(EngineApiTest, TheWorkerServesAVoiceInRealTime) {
    OpenEngine open(tinyModelPath, true);
    for (int update = 0; update < 2000 && open.statistics().inferences < 10; ++update) {
        open.publish(slidingState());
        (void)open.render(240);
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_GE(open.statistics().inferences, 10U);
    EXPECT_EQ(open.statistics().failures, 0U);
    EXPECT_GE(open.engineStatistics().rounds, 10U);
}

TEST(EngineApiTest, TheReasonForSilenceIsTold) {
    OpenEngine open(tinyModelPath);
    const auto silence = [&open] { return open.statistics().silence; };
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_REST);
    (void)open.update(slidingState());
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_NONE);
    ASSERT_EQ(haptoflow_voice_set_muted(open.voice, 1), HAPTOFLOW_OK);
    (void)open.render(256);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_MUTED);
    ASSERT_EQ(haptoflow_voice_set_muted(open.voice, 0), HAPTOFLOW_OK);
    ASSERT_EQ(haptoflow_voice_set_paused(open.voice, 1), HAPTOFLOW_OK);
    (void)open.render(256);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_PAUSED);
    ASSERT_EQ(haptoflow_voice_set_paused(open.voice, 0), HAPTOFLOW_OK);
    (void)open.render(5000);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_STALE);
    (void)open.update(slidingState());
    ASSERT_EQ(haptoflow_voice_panic(open.voice), HAPTOFLOW_OK);
    (void)open.update(slidingState());
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_PANIC);
    haptoflow_contact_state next = slidingState();
    next.touch_counter = 2;
    (void)open.update(next);
    EXPECT_EQ(silence(), HAPTOFLOW_SILENCE_NONE);
}

TEST(EngineApiTest, TheFailureTextIsEmptyAtFirstAndFitsAnyBuffer) {
    const OpenEngine open(tinyModelPath);
    uint64_t length = 99;
    std::array<char, 4> text{'x', 'x', 'x', 'x'};
    ASSERT_EQ(haptoflow_engine_last_failure(open.engine, text.data(), text.size(), &length), HAPTOFLOW_OK);
    EXPECT_EQ(length, 0U);
    EXPECT_EQ(text[0], '\0');
    EXPECT_EQ(haptoflow_engine_last_failure(open.engine, nullptr, 0, &length), HAPTOFLOW_OK);
    EXPECT_EQ(haptoflow_engine_last_failure(open.engine, nullptr, 4, &length), HAPTOFLOW_INVALID_ARGUMENT);
}

// Statistics of an engine and its voice after two seconds in which nothing slides.

constexpr uint32_t updatesInTwoSeconds = 144;
constexpr uint32_t framesOfAnUpdate = 667;

using VoiceFigures = std::array<std::uint64_t, sizeof(haptoflow_voice_statistics) / sizeof(std::uint64_t)>;

/// The parameter: without a worker, and with one.
class IdleStatisticsTest : public ::testing::TestWithParam<bool> {
protected:
    void play(const haptoflow_contact_state& state) {
        for (uint32_t update = 0; update < updatesInTwoSeconds; ++update) {
            open_.publish(state);
            EXPECT_EQ(peak(open_.render(framesOfAnUpdate)), 0.0F);
            if (!GetParam()) {
                open_.step();
            }
        }
    }

    /// Expects zero in every field that `expected` does not set, including fields added in later versions.
    void expectVoice(haptoflow_voice_statistics expected) const {
        expected.struct_size = sizeof(expected);
        expected.updates = updatesInTwoSeconds;
        expected.rendered_frames = updatesInTwoSeconds * framesOfAnUpdate;
        expected.device_rate_hz = 48000.0;
        expected.is_rate_supported = 1;
        expected.silence = HAPTOFLOW_SILENCE_REST;
        EXPECT_EQ(std::bit_cast<VoiceFigures>(open_.statistics()), std::bit_cast<VoiceFigures>(expected));
    }

    void expectIdleEngine() const {
        const haptoflow_engine_statistics found = open_.engineStatistics();
        EXPECT_EQ(found.voices, 1U);
        EXPECT_EQ(found.tier + found.is_measuring + found.rounds + found.segments + found.failed_rounds, 0U);
        EXPECT_EQ(found.wakes, wakesAtFirst_);
        EXPECT_EQ(found.quality_steps_down + found.quality_steps_up, 0U);
        EXPECT_EQ(found.last_round_ms, 0.0);
        EXPECT_EQ(found.worker_is_alive, 1U);
        if (!GetParam()) {
            EXPECT_EQ(found.priority_was_refused, 0U) << "without worker no priority is requested";
        }
        EXPECT_NEAR(found.budget_ms, 250.0 / 72.0, 1e-9);
        uint32_t tiers = 0;
        ASSERT_EQ(haptoflow_model_tier_count(open_.model, &tiers), HAPTOFLOW_OK);
        for (uint32_t tier = 0; tier < tiers; ++tier) {
            auto times = sized<haptoflow_tier_times>();
            ASSERT_EQ(haptoflow_engine_tier_times(open_.engine, tier, &times), HAPTOFLOW_OK);
            EXPECT_EQ(std::tie(times.runs, times.median_ms, times.percentile_99_ms), std::tuple(0U, 0.0, 0.0)) << tier;
        }
    }

    OpenEngine open_{tinyModelPath, GetParam()};
    std::uint64_t wakesAtFirst_ = open_.engineStatistics().wakes;
};

TEST_P(IdleStatisticsTest, WithoutTouchAllStatisticsButUpdatesAndFramesAreZero) {
    play(liftedState(0));
    expectVoice({});
    expectIdleEngine();
}

TEST_P(IdleStatisticsTest, ARestingTouchIsSkippedAndAllOtherStatisticsAreZero) {
    play(slidingState(0.0F, 2.0F));
    haptoflow_voice_statistics expected{};
    expected.skipped = updatesInTwoSeconds;
    expectVoice(expected);
    expectIdleEngine();
}

INSTANTIATE_TEST_SUITE_P(Engine, IdleStatisticsTest, ::testing::Bool(),
                         [](const auto& hasWorker) { return hasWorker.param ? "WithWorker" : "SteppedByHand"; });

}  // namespace
}  // namespace haptoflow::capi::testing
