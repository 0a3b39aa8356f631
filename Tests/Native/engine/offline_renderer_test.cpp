// Precision of time after a day. The simulated device uses steps of powers of two, so that its own sums stay exact.

#include "engine/offline_renderer.hpp"

#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;
using testing::whiteNoise;

std::vector<TimedContactState> statesOfSlide(double seconds) {
    return testing::statesOf(seconds, [](double) { return testing::sliding(); });
}

class OfflineRendererTest : public testing::DeviceTest {
protected:
    FakeGenerator noise_{whiteNoise};
};

TEST_F(OfflineRendererTest, TheSamplesDependOnlyOnStatesAndSeed) {
    const std::vector<TimedContactState> states = statesOfSlide(0.5);
    const OfflineRender first = renderOffline(model_, noise_, states, {.seed = 7});
    const OfflineRender second = renderOffline(model_, noise_, states, {.seed = 7});
    const OfflineRender other = renderOffline(model_, noise_, states, {.seed = 8});
    EXPECT_EQ(first.samples, second.samples);
    EXPECT_NE(first.samples, other.samples);
    EXPECT_EQ(first.samples.size(), static_cast<std::size_t>(std::llround((states.back().timeSeconds + 0.1) * 48000)));
}

/// Records only the number of samples and the largest piece.
class CountingSink final : public OfflineSink {
public:
    void output(std::span<const float> samples) override {
        outputSamples += samples.size();
        largestPiece = std::max(largestPiece, samples.size());
    }
    void waveform(std::span<const float> samplesMps2) override {
        waveformSamples += samplesMps2.size();
        largestPiece = std::max(largestPiece, samplesMps2.size());
    }

    std::size_t outputSamples = 0;
    std::size_t waveformSamples = 0;
    std::size_t largestPiece = 0;
};

TEST_F(OfflineRendererTest, AStreamedRenderArrivesPerUpdateAndHasTheSameStatistics) {
    const std::vector<TimedContactState> states = statesOfSlide(5.0);
    const OfflineRender whole = renderOffline(model_, noise_, states, {});
    CountingSink sink;
    std::size_t next = 0;
    const ContactStateSource source = [&]() -> std::optional<TimedContactState> {
        return next < states.size() ? std::optional(states[next++]) : std::nullopt;
    };
    const OfflineFigures streamed = renderOffline(model_, noise_, source, {}, sink);
    EXPECT_EQ(sink.outputSamples, whole.samples.size());
    EXPECT_EQ(sink.waveformSamples, whole.waveformMps2.size());
    // The tail of 0.1 s is the largest piece.
    EXPECT_LE(sink.largestPiece, 4800U);
    EXPECT_EQ(streamed.outputSamples, whole.samples.size());
    EXPECT_EQ(streamed.rmsMps2, whole.rmsMps2);
    EXPECT_EQ(streamed.peak, whole.peak);
    EXPECT_EQ(streamed.segments, states.size());
    EXPECT_EQ(streamed.underruns, 0U);
    EXPECT_EQ(streamed.seamStatistics.jumpRatio, whole.seamStatistics.jumpRatio);
}

TEST_F(OfflineRendererTest, InvalidStatesAreSanitisedAndCountedAndTheOutputIsFinite) {
    std::vector<TimedContactState> states = statesOfSlide(1.0);
    for (std::size_t i = 5; i < states.size(); i += 3) {
        states[i].velocityMps[0] = std::numeric_limits<float>::quiet_NaN();
        states[i].forceNewtons = std::numeric_limits<float>::infinity();
        states[i].material.weights[0] = -std::numeric_limits<float>::infinity();
    }
    states[8].timeSeconds = std::numeric_limits<double>::quiet_NaN();
    const OfflineRender render = renderOffline(model_, noise_, states, {});
    EXPECT_GT(render.sanitised, 60U);
    EXPECT_TRUE(std::ranges::all_of(render.samples, [](float sample) { return std::abs(sample) < 1.0F; }));
}

TEST_F(OfflineRendererTest, SettingsOutOfRangeAreRejected) {
    const std::vector<TimedContactState> states = statesOfSlide(0.1);
    EXPECT_THROW((void)renderOffline(model_, noise_, states, {.leadMs = -1.0}), std::invalid_argument);
    EXPECT_THROW((void)renderOffline(model_, noise_, states, {.outputRateHz = 4000.0}), std::invalid_argument);
    EXPECT_THROW((void)renderOffline(model_, noise_, states, {.fullScaleMps2 = 0.0F}), std::invalid_argument);
}

using testing::SimulatedDevice;

constexpr double daySeconds = 86'400.0;

/// Time for which a voice with a reading rate of four sounds before the comparison, from
/// HAPTOFLOW_TEST_SOUNDING_SECONDS; the soak test sets a quarter of a day.
double soundingSeconds() {
    const char* setting = std::getenv("HAPTOFLOW_TEST_SOUNDING_SECONDS");
    return setting != nullptr ? std::strtod(setting, nullptr) : 60.0;
}

class LongRunTest : public testing::DeviceTest {
protected:
    static testing::DeviceSettings settings() {
        return {.rateHz = 8192.0,
                .blockFrames = 64,
                .updateHz = 64.0,
                .latencySeconds = [](double) { return 1.0 / 512.0; },
                .fixedLeadSamples = 60};
    }

    /// The output of two seconds of sliding and half a second after lift-off.
    static std::vector<float> played(SimulatedDevice& device, std::uint32_t counter) {
        device.output.clear();
        device.run(2.0, [counter](double) { return touch(counter); });
        device.run(0.5, [counter](double) { return testing::lifted(counter); });
        return device.output;
    }

    /// The output of a new voice.
    std::vector<float> ofANewVoice() {
        SimulatedDevice fresh(model_, tone_, settings());
        std::vector<float> output = played(fresh, 1);
        EXPECT_GT(testing::peak(output), 0.5F / 60.0F);
        return output;
    }
};

TEST_F(LongRunTest, AVoiceWithAClockOneDayAheadSoundsLikeANewVoice) {
    SimulatedDevice device(model_, tone_, settings());
    // Only reading advances a voice's clock.
    auto& waveform = const_cast<Waveform&>(device.voice().renderer.voice().waveform());
    constexpr std::int64_t day = 86'400LL * 2000;
    std::vector<float> unheard(100'000);
    while (waveform.head() < day) {
        waveform.read(nullptr, unheard);
    }
    EXPECT_EQ(played(device, 1), ofANewVoice());
    EXPECT_GT(waveform.head(), day + 4000);
    EXPECT_EQ(device.counters().underruns, 0U);
}

TEST_F(LongRunTest, AStrokeRenderedOfflineADayLaterGivesTheSameBits) {
    const auto renderFrom = [this](double startSeconds) {
        const auto faster = [](double t) { return testing::sliding(0.1F + 0.072F * static_cast<float>(t)); };
        std::vector<TimedContactState> states = testing::statesOf(2.0, faster);
        for (TimedContactState& state : states) {
            state.timeSeconds += startSeconds;
        }
        FakeGenerator noise(testing::whiteNoise);
        return renderOffline(model_, noise, states, {}).samples;
    };
    const std::vector<float> now = renderFrom(0.0);
    EXPECT_GT(testing::peak(now), 0.5F / 60.0F);
    EXPECT_EQ(renderFrom(daySeconds), now);
}

TEST_F(LongRunTest, AVoiceAfterALongTouchSoundsLikeANewVoice) {
    SimulatedDevice device(model_, tone_, settings());
    const auto seconds = static_cast<int>(soundingSeconds());
    for (int second = 0; second < seconds; ++second) {
        device.run(1.0, [](double) { return testing::sliding(19.0F); });
        device.output.clear();
        device.waveform.samples.clear();
        device.waveform.seams.clear();
    }
    // The head advances by four times 2,000 samples a second, except at the beginning.
    EXPECT_GT(device.voice().renderer.voice().waveform().head(), 7900LL * seconds);
    device.run(1.0, [](double) { return testing::lifted(1); });
    EXPECT_EQ(played(device, 2), ofANewVoice());
    EXPECT_EQ(device.counters().underruns, 0U);
}

}  // namespace
}  // namespace haptoflow::engine
