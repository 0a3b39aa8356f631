// Precision of time after a day. The simulated device uses steps of powers of two, so that its own sums stay exact.
#include "engine/offline_renderer.hpp"

#include "fake_generators.hpp"
#include "simulated_device.hpp"
#include "test_model.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <vector>

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;
using testing::SimulatedDevice;

constexpr double daySeconds = 86'400.0;

/// Time for which a voice with a reading rate of four sounds before the comparison, from
/// HAPTOFLOW_TEST_SOUNDING_SECONDS; the soak test sets a quarter of a day.
double soundingSeconds() {
    const char* setting = std::getenv("HAPTOFLOW_TEST_SOUNDING_SECONDS");
    return setting != nullptr ? std::strtod(setting, nullptr) : 60.0;
}

class LongRunTest : public ::testing::Test {
protected:
    static testing::DeviceSettings settings() {
        testing::DeviceSettings settings;
        settings.rateHz = 8192.0;
        settings.blockFrames = 64;
        settings.updateHz = 64.0;
        settings.latencySeconds = [](double) { return 1.0 / 512.0; };
        settings.fixedLeadSamples = 60;
        return settings;
    }

    /// The output of two seconds of sliding and half a second after lift-off.
    static std::vector<float> touch(SimulatedDevice& device, std::uint32_t counter) {
        device.output.clear();
        device.run(2.0, [counter](double) {
            ContactState state = testing::sliding();
            state.touchCounter = counter;
            return state;
        });
        device.run(0.5, [counter](double) { return testing::lifted(counter); });
        return device.output;
    }

    /// The output of a new voice.
    std::vector<float> ofANewVoice() {
        SimulatedDevice fresh(model_, tone_, settings());
        std::vector<float> output = touch(fresh, 1);
        EXPECT_GT(testing::peak(output), 0.5F / 60.0F);
        return output;
    }

    model::ModelFile model_ = testing::smallModel();
    FakeGenerator tone_{testing::continueTone};
};

TEST_F(LongRunTest, AVoiceWithAClockOneDayAheadSoundsLikeANewVoice) {
    SimulatedDevice device(model_, tone_, settings());
    // Only reading advances a voice's clock, so this sets it forward by a day and by an odd number of samples, which
    // changes the position in the ring.
    auto& timeline = const_cast<WaveformTimeline&>(device.voice().renderer.voice().timeline());
    constexpr std::int64_t day = 86'400LL * 2000 + 333;
    TimelineView view;
    timeline.view(view);
    view.head += day;
    view.coveredUntil += day;
    timeline.restore(view);
    EXPECT_EQ(touch(device, 1), ofANewVoice());
    EXPECT_GT(timeline.head(), day + 4000);
    EXPECT_EQ(device.counters().underruns, 0U);
}

TEST_F(LongRunTest, AStrokeRenderedOfflineADayLaterGivesTheSameBits) {
    const auto renderFrom = [this](double startSeconds) {
        std::vector<TimedContactState> states;
        for (int update = 0; update < 144; ++update) {
            states.push_back(
                {testing::sliding(0.1F + 0.001F * static_cast<float>(update)), startSeconds + update / 72.0});
        }
        FakeGenerator noise(testing::whiteNoise);
        return renderOffline(model_, noise, states, {}).samples;
    };
    const std::vector<float> now = renderFrom(0.0);
    EXPECT_GT(testing::peak(now), 0.5F / 60.0F);
    EXPECT_EQ(renderFrom(daySeconds), now);
}

}  // namespace
}  // namespace haptoflow::engine
