// Concurrent uses of a voice. A sink holds a thread inside a render, which the C interface does not allow; therefore
// the tests use the voice table and the rendering functions directly.

#include "capi/voice_table.hpp"
#include "dsp/limiter.hpp"
#include "engine/fake_generators.hpp"
#include "engine/simulated_device.hpp"
#include "engine/test_model.hpp"
#include "open_engine.hpp"
#include "support/wave_measures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <thread>
#include <vector>

namespace haptoflow::capi::testing {
namespace {

using haptoflow::testing::largestStep;
using haptoflow::testing::peak;
using ::testing::Each;

constexpr std::uint32_t blockFrames = 256;

/// Blocks the first thread that plays samples until it is released.
class HoldingSink final : public engine::WaveformSink {
public:
    void played(std::int64_t /*start*/, std::span<const float> /*samplesMps2*/) noexcept override {
        if (!hasHeld_.exchange(true)) {
            entered_.set_value();
            leave_.get_future().wait();
        }
    }
    void tookOver(std::int64_t /*sample*/) noexcept override {}

    void waitUntilHeld() { entered_.get_future().wait(); }
    void letGo() { leave_.set_value(); }

private:
    std::atomic<bool> hasHeld_{false};
    // No latches: with libstdc++ 12 on Windows a waiting thread is sometimes not woken.
    std::promise<void> entered_;
    std::promise<void> leave_;
};

class VoiceTableTest : public ::testing::Test {
protected:
    VoiceTableTest() {
        engine::EngineTiers tiers;
        auto model = std::make_shared<const model::ModelFile>(engine::testing::calmSkeletonModel());
        tiers.push_back(std::make_unique<inference::SkeletonGenerator>(skeleton::readNativeParts(*model), 1));
        engine::LiveEngineSettings settings;
        settings.quality.fixedTier = 0;
        settings.hasWorker = false;
        engine_ = std::make_shared<engine::LiveEngine>(std::move(model), std::move(tiers), 0, settings);
        auto opened = std::make_unique<OpenVoice>();
        opened->engine = engine_;
        opened->voice = engine_->addVoice(48000.0);
        opened->voice->renderer.setSink(&sink_);
        engine_->publish(*opened->voice, engine::testing::sliding());
        live_ = opened->voice;
        handle_ = table_.open(std::move(opened));
    }

    /// Renders a block into the second of two channels of a buffer filled with nines.
    haptoflow_status render(std::vector<float>& interleaved) {
        interleaved.assign(std::size_t{blockFrames} * 2, 9.0F);
        return renderInto(table_.useToRender(handle_), {interleaved.data(), blockFrames, 2, 1}, 48000.0);
    }

    static std::vector<float> channel(const std::vector<float>& interleaved, std::size_t index) {
        std::vector<float> samples;
        for (std::size_t i = index; i < interleaved.size(); i += 2) {
            samples.push_back(interleaved[i]);
        }
        return samples;
    }

    /// One thread renders and is held inside; meanwhile this one closes the voice, which then fades and ends.
    void closeDuringARender(const std::function<void()>& close) {
        std::vector<float> output(blockFrames);
        haptoflow_status status = HAPTOFLOW_INTERNAL_ERROR;
        std::thread renderer([&] {
            status = renderInto(table_.useToRender(handle_), {output.data(), blockFrames, 1, 0}, 48000.0);
        });
        sink_.waitUntilHeld();
        // Returns although the render cannot: with a wait, this test would never end.
        close();
        EXPECT_FALSE(table_.use(handle_)) << "a closed voice is refused by all but its renderer";
        EXPECT_EQ(engine_->statistics().voices, 0U);
        EXPECT_FALSE(live_.expired());
        sink_.letGo();
        renderer.join();
        EXPECT_EQ(status, HAPTOFLOW_OK);
        EXPECT_GT(peak(output), 0.0F) << "the running block is complete";

        std::vector<float> block;
        std::vector<float> rest = output;
        for (int blocks = 0; render(block) == HAPTOFLOW_OK && blocks < 10; ++blocks) {
            const std::vector<float> samples = channel(block, 1);
            rest.insert(rest.end(), samples.begin(), samples.end());
        }
        EXPECT_GT(rest.size(), output.size()) << "the fade is rendered";
        EXPECT_EQ(rest.back(), 0.0F);
        EXPECT_LE(largestStep(std::span(rest).subspan(output.size() - 1)), 1.5F * largestStep(output));
        EXPECT_EQ(render(block), HAPTOFLOW_INVALID_ARGUMENT) << "it has ended";
        table_.closeAll(*engine_);
        EXPECT_TRUE(live_.expired()) << "the next call of the table frees it";
    }

    HoldingSink sink_;
    VoiceTable table_;
    std::shared_ptr<engine::LiveEngine> engine_;
    std::weak_ptr<engine::LiveVoice> live_;
    haptoflow_voice handle_ = 0;
};

TEST_F(VoiceTableTest, ASecondThreadThatRendersAVoiceIsRefusedGetsSilenceAndIsCounted) {
    std::vector<float> first;
    haptoflow_status firstStatus = HAPTOFLOW_INTERNAL_ERROR;
    std::thread other([&] { firstStatus = render(first); });
    sink_.waitUntilHeld();
    std::vector<float> second;
    EXPECT_EQ(render(second), HAPTOFLOW_BUSY);
    EXPECT_THAT(channel(second, 1), Each(0.0F));
    EXPECT_THAT(channel(second, 0), Each(9.0F)) << "other channels are unchanged";
    EXPECT_EQ(table_.use(handle_)->refusedCalls, 1U);
    sink_.letGo();
    other.join();
    EXPECT_EQ(firstStatus, HAPTOFLOW_OK);
    EXPECT_GT(peak(channel(first, 1)), 0.0F);
    EXPECT_EQ(table_.use(handle_)->voice->channels.counters.renderedFrames, blockFrames);

    EXPECT_EQ(render(second), HAPTOFLOW_OK) << "the voice can be rendered again";
    EXPECT_GT(peak(channel(second, 1)), 0.0F);
    EXPECT_EQ(table_.use(handle_)->refusedCalls, 1U);
    EXPECT_TRUE(table_.close(handle_));
}

TEST_F(VoiceTableTest, EachBlockIsRenderedOnceOrRefusedWhenTwoThreadsRenderOneVoice) {
    sink_.letGo();
    std::atomic<std::uint64_t> rendered{0};
    std::atomic<std::uint64_t> refused{0};
    const auto renderMany = [&] {
        std::vector<float> block;
        for (int i = 0; i < 500; ++i) {
            const haptoflow_status status = render(block);
            EXPECT_THAT(channel(block, 0), Each(9.0F));
            if (status == HAPTOFLOW_OK) {
                ++rendered;
            } else {
                EXPECT_EQ(status, HAPTOFLOW_BUSY);
                ++refused;
            }
        }
    };
    std::thread other(renderMany);
    renderMany();
    other.join();
    EXPECT_EQ(rendered + refused, 1000U);
    EXPECT_GT(rendered, 0U);
    EXPECT_EQ(table_.use(handle_)->refusedCalls, refused);
    EXPECT_EQ(table_.use(handle_)->voice->channels.counters.renderedFrames, rendered * blockFrames);
    EXPECT_TRUE(table_.close(handle_));
}

TEST_F(VoiceTableTest, AVoiceClosedDuringARenderFadesAfterItAndNobodyWaits) {
    closeDuringARender([this] { EXPECT_TRUE(table_.close(handle_)); });
}

TEST_F(VoiceTableTest, AnEngineClosedDuringARenderFadesItsVoiceAfterItAndNobodyWaits) {
    closeDuringARender([this] { table_.closeAll(*engine_); });
}

// Several voices on one output: haptoflow_voices_render. Voices of engines with one seed have one waveform, so that the
// sum of two of them is known.

constexpr uint32_t frames = 512;
/// No sample reaches the knee.
constexpr double linearMps2 = 1e6;
/// Most samples of one voice lie above the knee.
constexpr double loudMps2 = 1.0;

class VoiceSumTest : public ::testing::Test {
protected:
    /// A voice that begins to slide in its next block, the first of an engine of its own.
    haptoflow_voice slidingVoice(double fullScaleMps2, float ceiling = 1.0F) {
        haptoflow_engine_options options = engineOptions(runtime_, model_);
        options.full_scale_mps2 = fullScaleMps2;
        EngineHandle& engine = engines_.emplace_back(createEngine(options));
        haptoflow_voice voice = 0;
        const haptoflow_contact_state state = slidingState(0.3F, 3.0F);
        EXPECT_EQ(haptoflow_voice_create(engine, 48000.0, &voice), HAPTOFLOW_OK) << message();
        EXPECT_EQ(haptoflow_voice_set_ceiling(voice, ceiling), HAPTOFLOW_OK);
        EXPECT_EQ(haptoflow_voice_publish(voice, &state), HAPTOFLOW_OK);
        return voice;
    }

    static std::vector<float> sumOf(std::vector<haptoflow_voice>& voices) {
        std::vector<float> samples(frames, 9.0F);
        EXPECT_EQ(haptoflow_voices_render(voices.data(), static_cast<uint32_t>(voices.size()), samples.data(), frames,
                                          1, 0, 48000.0),
                  HAPTOFLOW_OK);
        return samples;
    }
    static std::vector<float> sumOf(std::vector<haptoflow_voice>&& voices) { return sumOf(voices); }

    static std::vector<float> alone(haptoflow_voice voice) {
        std::vector<float> samples(frames, 9.0F);
        EXPECT_EQ(haptoflow_voice_render(voice, samples.data(), frames, 1, 0, 48000.0), HAPTOFLOW_OK);
        return samples;
    }

    /// What a voice plays, in m/s^2.
    std::vector<float> waveMps2() {
        std::vector<float> wave = alone(slidingVoice(linearMps2));
        std::ranges::transform(wave, wave.begin(), [](float share) { return share * static_cast<float>(linearMps2); });
        return wave;
    }
    /// The limiter's curve on a wave times `scale`.
    static std::vector<float> limited(std::vector<float> wave, float scale) {
        std::ranges::transform(wave, wave.begin(), [scale](float sample) { return scale * sample; });
        dsp::SoftLimiter(1.0F).processScaled(wave);
        return wave;
    }

    RuntimeHandle runtime_{openRuntime()};
    ModelHandle model_{openModel(defaultModelPath)};
    std::list<EngineHandle> engines_;
};

TEST_F(VoiceSumTest, TwoVoicesPassTheCurveOnceAsASumAndAreNotClipped) {
    const std::vector<float> wave = waveMps2();
    const std::vector<float> sum = sumOf({slidingVoice(loudMps2), slidingVoice(loudMps2)});
    ASSERT_GT(peak(wave), 1.5F) << "each would be limited alone";
    const std::vector<float> expected = limited(wave, 2.0F / static_cast<float>(loudMps2));
    for (std::size_t i = 0; i < frames; ++i) {
        ASSERT_NEAR(sum[i], expected[i], 1e-5F) << i;
    }
    EXPECT_LT(peak(sum), 1.0F);
}

TEST_F(VoiceSumTest, ThreeVoicesOfDifferentFullScalesEachKeepTheirOwn) {
    const std::vector<float> wave = waveMps2();
    const std::vector<float> sum = sumOf({slidingVoice(loudMps2), slidingVoice(4.0), slidingVoice(linearMps2)});
    const std::vector<float> expected = limited(wave, 1.0F + 0.25F + static_cast<float>(1.0 / linearMps2));
    for (std::size_t i = 0; i < frames; ++i) {
        ASSERT_NEAR(sum[i], expected[i], 1e-5F) << i;
    }
}

TEST_F(VoiceSumTest, TheLowestCeilingLimitsTheSumAndACeilingOf0SilencesItsOwnVoiceOnly) {
    EXPECT_LT(peak(sumOf({slidingVoice(loudMps2), slidingVoice(loudMps2, 0.25F)})), 0.25F);
    const std::vector<float> own = alone(slidingVoice(loudMps2));
    EXPECT_EQ(sumOf({slidingVoice(loudMps2, 0.0F), slidingVoice(loudMps2)}), own);
    EXPECT_THAT(sumOf({slidingVoice(loudMps2, 0.0F), slidingVoice(loudMps2, 0.0F)}), Each(0.0F));
}

TEST_F(VoiceSumTest, WithoutAVoiceZerosAreWrittenAndWhatHasEndedIsForgotten) {
    EXPECT_THAT(sumOf({}), Each(0.0F));
    haptoflow_voice destroyed = slidingVoice(loudMps2);
    const haptoflow_voice kept = slidingVoice(loudMps2);
    std::vector<haptoflow_voice> voices{destroyed, kept};
    (void)sumOf(voices);
    ASSERT_EQ(haptoflow_voice_destroy(&destroyed), HAPTOFLOW_OK);
    (void)sumOf(voices);
    (void)sumOf(voices);
    EXPECT_EQ(voices, (std::vector<haptoflow_voice>{0, kept})) << "once it has faded";
}

TEST_F(VoiceSumTest, OneOfTwoVoicesThatEndsFadesInTheSumWithoutAStep) {
    haptoflow_voice destroyed = slidingVoice(loudMps2);
    const haptoflow_voice kept = slidingVoice(loudMps2);
    std::vector<haptoflow_voice> voices{destroyed, kept};
    std::vector<float> output = sumOf(voices);
    const float usual = largestStep(output);
    ASSERT_EQ(haptoflow_voice_destroy(&destroyed), HAPTOFLOW_OK);
    for (int block = 0; block < 3; ++block) {
        const std::vector<float> next = sumOf(voices);
        output.insert(output.end(), next.begin(), next.end());
    }
    EXPECT_LE(largestStep(output), 1.5F * usual);
    EXPECT_GT(peak(std::vector<float>(output.end() - 100, output.end())), 0.1F) << "the other one goes on";
}

TEST_F(VoiceSumTest, BlocksOfAnyLengthAndOneChannelOfSeveralAreWritten) {
    std::vector<haptoflow_voice> voices{slidingVoice(loudMps2), slidingVoice(loudMps2)};
    std::vector<float> interleaved(2 * 20'000, 9.0F);
    ASSERT_EQ(haptoflow_voices_render(voices.data(), 2, interleaved.data(), 20'000, 2, 1, 48000.0), HAPTOFLOW_OK);
    float loudest = 0.0F;
    for (std::size_t frame = 0; frame < 20'000; ++frame) {
        ASSERT_EQ(interleaved[2 * frame], 9.0F);
        loudest = std::max(loudest, std::abs(interleaved[2 * frame + 1]));
    }
    EXPECT_GT(loudest, 0.7F);
    EXPECT_LT(loudest, 1.0F);
    EXPECT_EQ(haptoflow_voices_render(voices.data(), 2, interleaved.data(), 8, 2, 2, 48000.0),
              HAPTOFLOW_INVALID_ARGUMENT);
}

}  // namespace
}  // namespace haptoflow::capi::testing
