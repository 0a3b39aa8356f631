#include "engine/contact_publisher.hpp"
#include "engine/offline_renderer.hpp"
#include "engine/tap_pieces.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

using effects::EffectKind;
using effects::EffectMask;
using effects::maskOf;
using testing::SimulatedDevice;

constexpr EffectMask impact = maskOf(EffectKind::impact);
constexpr EffectMask edge = maskOf(EffectKind::edge);
constexpr std::array<std::size_t, 6> blockLengths{64, 128, 256, 512, 1024, 2048};

ContactState landing(float approachSpeedMps, std::uint32_t touch = 1) {
    ContactState state = testing::sliding(0.0F);
    state.touchCounter = touch;
    state.approachSpeedMps = approachSpeedMps;
    state.effects = impact;
    return state;
}

/// A tip on ribs: `edges` of them crossed, each a full edge.
ContactState onRibs(std::uint32_t edges, float speedMps = 0.2F) {
    ContactState state = testing::sliding(speedMps);
    state.effects = edge;
    state.edgeCounter = edges;
    state.edgeHeightMetres = 0.002F;
    return state;
}

/// Landings every 20 ms from 0.1 s to 1.6 s, every second one weak; the tip lifts off between them.
ContactState taps(double seconds) {
    // Whole milliseconds, because the sum of many periods is not exact.
    const auto milliseconds = static_cast<std::uint32_t>(std::lround(1000.0 * seconds));
    if (milliseconds < 100 || milliseconds >= 1600) {
        return testing::lifted(milliseconds < 100 ? 0 : 75);
    }
    const std::uint32_t tap = (milliseconds - 100) / 20;
    ContactState state = landing(tap % 2 == 0 ? 0.3F : 0.02F, tap + 1);
    state.touching = milliseconds % 20 <= 10;
    return state;
}

/// Ribs every 5 ms from 0.1 s to 1.6 s.
ContactState ribs(double seconds) {
    const double since = std::clamp(seconds - 0.1, 0.0, 1.5);
    return onRibs(static_cast<std::uint32_t>(since / 0.005 + 1e-6));
}

struct Scene {
    std::string name;
    EffectKind kind;
    std::function<ContactState(double)> hand;
};

std::ostream& operator<<(std::ostream& stream, const Scene& scene) {
    return stream << scene.name;
}

const std::vector<Scene>& scenes() {
    static const std::vector<Scene> all{{"Landings", EffectKind::impact, taps}, {"Ribs", EffectKind::edge, ribs}};
    return all;
}

double energy(std::span<const float> samples) {
    return std::transform_reduce(samples.begin(), samples.end(), 0.0, std::plus<>(), [](float sample) {
        return static_cast<double>(sample) * static_cast<double>(sample);
    });
}

class ContactEventsTest : public testing::DeviceTest {
protected:
    static std::uint64_t events(const SimulatedDevice& device, EffectKind kind) { return of(device, kind).events; }
    [[nodiscard]] std::vector<float> play(std::size_t blockFrames, const std::vector<ContactState>& states,
                                          int blocks = 8) {
        SimulatedDevice device(model_, tone_, {.blockFrames = blockFrames});
        for (const ContactState& state : states) {
            device.publish(state);
        }
        renderBlocks(device, blocks);
        return device.output;
    }
};

TEST_F(ContactEventsTest, AStrongBlowSoundsEvenIfAWeakOneFollowsInTheSameBlock) {
    for (const std::size_t block : blockLengths) {
        const std::vector<float> alone = play(block, {landing(2.0F, 1)});
        const std::vector<float> both = play(block, {landing(2.0F, 1), testing::lifted(1), landing(0.01F, 2)});
        EXPECT_GT(testing::peak(both), 0.98F * testing::peak(alone)) << block;
        EXPECT_NE(both, alone) << "the weak event sounds, too; block of " << block;
    }
}

TEST_F(ContactEventsTest, BlowsOfOneBlockKeepTheirDistance) {
    constexpr std::size_t block = 2048;
    std::vector<ContactState> first;
    for (int state = 0; state < 20; ++state) {
        first.push_back(onRibs(state >= 3 ? 1 : 0));
    }
    std::vector<ContactState> both = first;
    for (std::size_t state = 13; state < both.size(); ++state) {
        both[state].edgeCounter = 2;
    }
    const std::vector<float> one = play(block, first);
    const std::vector<float> two = play(block, both);
    const auto differs = std::ranges::mismatch(one, two).in1 - one.begin();
    // Ten of twenty states later. The sinusoid of the second event begins at 0, so its second sample differs.
    EXPECT_NEAR(static_cast<double>(differs), block / 2, 2);
    EXPECT_NE(one[1], 0.0F) << "the first event begins with its block";
    for (std::size_t i = 0; i + block / 2 + 1 < two.size(); ++i) {
        const double second = static_cast<double>(two[i + block / 2]) - static_cast<double>(one[i + block / 2]);
        ASSERT_NEAR(second, static_cast<double>(one[i]), 1e-5) << "both contact events are equal; sample " << i;
    }
}

TEST_F(ContactEventsTest, OfTwoLandingsInOneBlockAPanicBetweenSilencesTheFirst) {
    for (const std::size_t block : blockLengths) {
        const auto peakOf = [&](float before, float after) {
            SimulatedDevice device(model_, tone_, {.blockFrames = block});
            device.publish(landing(before, 1));
            device.publish(testing::lifted(1));
            device.voice().channels.panic();
            device.publish(landing(after, 2));
            renderBlocks(device, 8);
            EXPECT_EQ(events(device, EffectKind::impact), 1U) << block;
            return testing::peak(device.output);
        };
        EXPECT_FLOAT_EQ(peakOf(2.0F, 0.1F), peakOf(0.01F, 0.1F)) << block;
    }
}

TEST_F(ContactEventsTest, ABlowThatWaitedTooLongForARateIsNotPlayedLater) {
    SimulatedDevice device(model_, tone_);
    device.run(0.2, [](double) { return testing::lifted(0); });
    // Without calls of the worker, no output stage is made.
    device.setRate(44100.0);
    device.voice().publisher.publish(landing(0.5F, 1));
    for (int block = 0; block < 20; ++block) {
        device.renderBlock();
        device.voice().publisher.publish(landing(0.5F, 1));
    }
    device.run(0.2, [](double) { return landing(0.5F, 1); });
    EXPECT_EQ(device.counters().rateChanges, 1U);
    EXPECT_EQ(events(device, EffectKind::impact), 0U);
    EXPECT_EQ(testing::peak(device.output), 0.0F);
}

TEST_F(ContactEventsTest, OfMoreBlowsThanAreKeptTheStrongestSoundAndTheOthersAreCounted) {
    SimulatedDevice device(model_, tone_, {.blockFrames = 2048});
    constexpr std::uint32_t published = 3 * ContactEventList::capacity;
    for (std::uint32_t touch = 1; touch <= published; ++touch) {
        device.publish(landing(touch % 3 == 0 ? 0.2F : 0.01F, touch));
    }
    device.renderBlock();
    EXPECT_EQ(events(device, EffectKind::impact), ContactEventList::capacity);
    EXPECT_EQ(device.counters().lostEvents, published - ContactEventList::capacity);
    SimulatedDevice strongest(model_, tone_, {.blockFrames = 2048});
    for (std::uint32_t touch = 1; touch <= published; ++touch) {
        strongest.publish(touch % 3 == 0 ? landing(0.2F, touch) : landing(0.0F, touch));
    }
    strongest.renderBlock();
    EXPECT_EQ(device.output, strongest.output);
}

std::atomic<double> testSeconds{0.0};

TEST_F(ContactEventsTest, BlowsFromATimeInWhichTheDeviceStoodStillAreNotPlayedAllAtOnce) {
    SimulatedDevice device(model_, tone_);
    device.voice().channels.isRealTime = true;
    device.voice().channels.clock = []() noexcept { return testSeconds.load(); };
    testSeconds = 10.0;
    device.publish(onRibs(0));
    device.renderBlock();
    for (std::uint32_t edges = 1; edges <= 50; ++edges) {
        testSeconds = testSeconds + 1.0 / 72.0;
        device.publish(onRibs(edges));
    }
    device.renderBlock();
    EXPECT_LE(events(device, EffectKind::edge), 9U) << "those of the last 100 ms and two blocks";
    EXPECT_GE(events(device, EffectKind::edge), 7U);
}

TEST_F(ContactEventsTest, ACallerThatCountsTouchesFromZeroFeelsItsFirstLanding) {
    SimulatedDevice device(model_, tone_);
    device.publish(landing(0.5F, 0));
    device.renderBlock();
    EXPECT_EQ(events(device, EffectKind::impact), 1U);
    EXPECT_GT(testing::peak(device.output), 0.01F);
    // The touch goes on.
    device.run(0.1, [](double) { return landing(0.5F, 0); });
    EXPECT_EQ(events(device, EffectKind::impact), 1U);
    device.run(0.1, [](double) { return testing::lifted(0); });
    device.run(0.1, [](double) { return landing(0.5F, 1); });
    EXPECT_EQ(events(device, EffectKind::impact), 2U);
}

TEST_F(ContactEventsTest, ACallerThatDoesNotCountTouchesFeelsEachLanding) {
    for (const bool startsLifted : {false, true}) {
        SimulatedDevice device(model_, tone_);
        if (startsLifted) {
            device.run(0.1, [](double) { return testing::lifted(0); });
        }
        for (std::uint64_t touch = 1; touch <= 4; ++touch) {
            device.run(0.1, [](double) { return landing(0.5F, 0); });
            EXPECT_EQ(events(device, EffectKind::impact), touch);
            device.run(0.1, [](double) { return testing::lifted(0); });
        }
    }
}

class EventLoudnessTest : public ContactEventsTest, public ::testing::WithParamInterface<std::tuple<Scene, double>> {};

TEST_P(EventLoudnessTest, DoesNotDependOnTheBlockLengthNorOnRenderingLiveOrOffline) {
    const auto& [scene, rateHz] = GetParam();
    const std::vector<TimedContactState> states = testing::statesOf(2.5, scene.hand, 1000.0);
    OfflineSettings settings;
    settings.outputRateHz = rateHz;
    settings.fullScaleMps2 = 60.0F;
    const OfflineRender offline = renderOffline(model_, tone_, states, settings);
    const std::uint64_t contactEvents = offline.effectEvents[static_cast<std::size_t>(scene.kind)];
    ASSERT_GE(contactEvents, 75U);
    const double expected = energy(offline.samples);
    for (const std::size_t block : blockLengths) {
        SimulatedDevice device(model_, tone_, {.rateHz = rateHz, .blockFrames = block, .updateHz = 1000.0});
        device.run(2.5, [&hand = scene.hand](double seconds) { return hand(seconds); });
        EXPECT_EQ(events(device, scene.kind), contactEvents) << block;
        EXPECT_NEAR(10.0 * std::log10(energy(device.output) / expected), 0.0, 0.3) << block;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, EventLoudnessTest,
                         ::testing::Combine(::testing::ValuesIn(scenes()),
                                            ::testing::Values(24000.0, 44100.0, 48000.0, 96000.0)),
                         [](const auto& test) {
                             return std::get<0>(test.param).name + "At" +
                                    std::to_string(static_cast<int>(std::get<1>(test.param))) + "Hz";
                         });

TEST_F(ContactEventsTest, ALandingAndALiftOffInOneBlockSound) {
    for (const std::size_t block : blockLengths) {
        const std::vector<float> held = play(block, {testing::lifted(0), landing(0.5F, 1)});
        const std::vector<float> tapped = play(block, {testing::lifted(0), landing(0.5F, 1), testing::lifted(1)});
        EXPECT_EQ(held, tapped) << block;
        EXPECT_GT(testing::peak(tapped), 0.01F) << block;
    }
}

TEST_F(ContactEventsTest, ALandingInTheFrameInWhichTheRateChangesSounds) {
    for (const double rateHz : {16000.0, 44100.0, 96000.0}) {
        for (const bool isRib : {false, true}) {
            SimulatedDevice device(model_, tone_);
            const EffectKind kind = isRib ? EffectKind::edge : EffectKind::impact;
            device.run(0.2, [&](double) { return isRib ? onRibs(0) : testing::lifted(0); });
            device.setRate(rateHz);
            const std::size_t begin = device.output.size();
            const ContactState event = isRib ? onRibs(1) : landing(0.5F, 1);
            device.publish(event);
            device.renderBlock();
            device.run(0.2, [&](double) { return event; });
            EXPECT_EQ(events(device, kind), 1U) << rateHz;
            EXPECT_GT(testing::peak(std::span<const float>(device.output).subspan(begin)), 0.005F) << rateHz;
        }
    }
}

ContactState sliding(float speedMps, std::uint32_t touchCounter = 1) {
    ContactState state;
    state.touching = true;
    state.touchCounter = touchCounter;
    state.velocityMps = {speedMps, 0.0F};
    return state;
}

TEST(ContactFollowerTest, SlidingGivesAnOnsetThenSlidesThenARelease) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(ContactState{}, 0.0), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.05F), 0.0), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F), 0.0), ContactAction::slide);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}, 0.0), ContactAction::release);
    EXPECT_EQ(follower.update(ContactState{.touchCounter = 1}, 0.0), ContactAction::rest);
}

TEST(ContactFollowerTest, ANewTouchBetweenTwoUpdatesStartsANewOnset) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.05F, 1), 0.0), ContactAction::onset);
    EXPECT_EQ(follower.update(sliding(0.05F, 2), 0.0), ContactAction::onset);
}

TEST(ContactFollowerTest, ATipThatRestsOnTheSurfaceIsSilent) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0F), 0.0), ContactAction::rest);
    EXPECT_EQ(follower.update(sliding(0.003F), 0.0), ContactAction::rest);
}

TEST(ContactFollowerTest, AroundTheThresholdTheActionDoesNotFlicker) {
    ContactFollower follower;
    EXPECT_EQ(follower.update(sliding(0.0045F), 0.0), ContactAction::onset);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(follower.update(sliding(i % 2 == 0 ? 0.0025F : 0.0045F), 0.0), ContactAction::slide);
    }
    EXPECT_EQ(follower.update(sliding(0.0015F), 0.0), ContactAction::release);
    EXPECT_EQ(follower.update(sliding(0.003F), 0.0), ContactAction::rest);
}

/// A tip on a surface, 90 times a second, with the places that a function of time gives.
class PlacedTip {
public:
    template <typename Place>
    int framesSliding(double seconds, Place&& placeMetres, float speedMps) {
        int frames = 0;
        for (int frame = 0; frame < static_cast<int>(seconds * 90.0); ++frame) {
            now_ += 1.0 / 90.0;
            ContactState state = sliding(speedMps);
            state.hasPlace = 1;
            state.placeMetres = {1.0F + static_cast<float>(placeMetres(static_cast<double>(frame) / 90.0)), 0.5F, 0.0F};
            last_ = follower_.update(state, now_);
            frames += follower_.sliding() ? 1 : 0;
        }
        return frames;
    }
    [[nodiscard]] ContactAction last() const { return last_; }
    [[nodiscard]] bool slides() const { return follower_.sliding(); }

private:
    ContactFollower follower_;
    ContactAction last_ = ContactAction::rest;
    double now_ = 0.0;
};

double tremorMetres(double seconds, double amplitudeMetres) {
    return amplitudeMetres * std::sin(2.0 * std::numbers::pi * 9.0 * seconds);
}

TEST(ContactFollowerPlaceTest, AHeldTipThatTremblesFasterThanItCreepsNeverSlides) {
    for (const double amplitude : {0.00002, 0.0002, 0.00049}) {
        PlacedTip tip;
        const auto speed = static_cast<float>(2.0 * std::numbers::pi * 9.0 * amplitude);
        EXPECT_EQ(tip.framesSliding(
                      20.0, [&](double t) { return tremorMetres(t, amplitude); }, speed),
                  0)
            << amplitude;
    }
}

TEST(ContactFollowerPlaceTest, ACreepingTipSlidesAfterAMillimetreAndGoesOn) {
    for (const double speed : {0.001, 0.002, 0.003, 0.01}) {
        PlacedTip tip;
        const int frames = tip.framesSliding(
            5.0, [&](double t) { return speed * t; }, static_cast<float>(speed));
        EXPECT_NEAR(frames, 450.0 - 90.0 * 0.001 / speed, 3.0) << speed;
    }
}

TEST(ContactFollowerPlaceTest, AStrokeSlidesInItsSecondFrameAndATouchAtSpeedAtOnce) {
    PlacedTip tip;
    (void)tip.framesSliding(
        0.5, [](double) { return 0.0; }, 0.0F);
    EXPECT_EQ(tip.framesSliding(
                  2.01 / 90.0, [](double t) { return 0.1 * t; }, 0.1F),
              1);
    PlacedTip landing;
    EXPECT_EQ(landing.framesSliding(
                  1.01 / 90.0, [](double) { return 0.0; }, 0.1F),
              1);
    PlacedTip resting;
    EXPECT_EQ(resting.framesSliding(
                  1.01 / 90.0, [](double) { return 0.0; }, 0.01F),
              0);
}

TEST(ContactFollowerPlaceTest, AStopEndsSlidingAtOnceAndAStopWithTremorWithinTheHold) {
    PlacedTip tip;
    (void)tip.framesSliding(
        0.5, [](double t) { return 0.1 * t; }, 0.1F);
    ASSERT_TRUE(tip.slides());
    EXPECT_EQ(tip.framesSliding(
                  0.2, [](double) { return 0.049; }, 0.0F),
              0);
    PlacedTip trembling;
    (void)trembling.framesSliding(
        0.5, [](double t) { return 0.1 * t; }, 0.1F);
    const int frames = trembling.framesSliding(
        3.0, [](double t) { return 0.049 + tremorMetres(t, 0.0003); }, 0.017F);
    EXPECT_LE(frames, 0.15 * 90.0 + 4.0);
    EXPECT_FALSE(trembling.slides());
}

TEST(ContactFollowerPlaceTest, AReversalAtTheSpeedOfHandwritingIsOneStroke) {
    for (const double speed : {0.01, 0.027, 0.1, 0.5}) {
        PlacedTip tip;
        (void)tip.framesSliding(
            1.0, [&](double t) { return speed * t; }, static_cast<float>(speed));
        ASSERT_TRUE(tip.slides());
        EXPECT_EQ(tip.framesSliding(
                      1.0, [&](double t) { return speed * (1.0 - t); }, static_cast<float>(speed)),
                  90)
            << speed;
    }
}

}  // namespace
}  // namespace haptoflow::engine
