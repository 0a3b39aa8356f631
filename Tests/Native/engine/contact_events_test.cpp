#include "engine/contact_publisher.hpp"
#include "engine/offline_renderer.hpp"
#include "simulated_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>
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

TEST_F(ContactEventsTest, LoudnessDoesNotDependOnTheBlockLengthNorOnRenderingLiveOrOffline) {
    using haptoflow::testing::sumOfSquares;
    for (const auto& [kind, hand] : {std::pair(EffectKind::impact, &taps), std::pair(EffectKind::edge, &ribs)}) {
        for (const double rateHz : {24000.0, 44100.0, 48000.0, 96000.0}) {
            const OfflineRender offline = renderOffline(model_, tone_, testing::statesOf(2.5, hand, 1000.0),
                                                        {.outputRateHz = rateHz, .fullScaleMps2 = 60.0F});
            const std::uint64_t contactEvents = offline.effectEvents[static_cast<std::size_t>(kind)];
            ASSERT_GE(contactEvents, 75U);
            for (const std::size_t block : blockLengths) {
                SimulatedDevice device(model_, tone_, {.rateHz = rateHz, .blockFrames = block, .updateHz = 1000.0});
                device.run(2.5, hand);
                EXPECT_EQ(events(device, kind), contactEvents) << block << " frames at " << rateHz << " Hz";
                EXPECT_NEAR(10.0 * std::log10(sumOfSquares(device.output) / sumOfSquares(offline.samples)), 0.0, 0.3)
                    << block << " frames at " << rateHz << " Hz";
            }
        }
    }
}

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

/// A tip without a place, told by its speed.
class ContactFollowerTest : public ::testing::Test {
protected:
    ContactAction update(float speedMps, std::uint32_t touchCounter = 1) {
        ContactState state = testing::sliding(speedMps);
        state.touchCounter = touchCounter;
        return follower_.update(state, 0.0);
    }

    ContactFollower follower_;
};

TEST_F(ContactFollowerTest, SlidingGivesAnOnsetThenSlidesThenARelease) {
    EXPECT_EQ(follower_.update(testing::lifted(0), 0.0), ContactAction::rest);
    EXPECT_EQ(update(0.05F), ContactAction::onset);
    EXPECT_EQ(update(0.05F), ContactAction::slide);
    EXPECT_EQ(follower_.update(testing::lifted(), 0.0), ContactAction::release);
    EXPECT_EQ(follower_.update(testing::lifted(), 0.0), ContactAction::rest);
}

TEST_F(ContactFollowerTest, ANewTouchBetweenTwoUpdatesStartsANewOnset) {
    EXPECT_EQ(update(0.05F, 1), ContactAction::onset);
    EXPECT_EQ(update(0.05F, 2), ContactAction::onset);
}

TEST_F(ContactFollowerTest, ATipThatRestsIsSilentAndAroundTheThresholdTheActionDoesNotFlicker) {
    EXPECT_EQ(update(0.0F), ContactAction::rest);
    EXPECT_EQ(update(0.003F), ContactAction::rest);
    EXPECT_EQ(update(0.0045F), ContactAction::onset);
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(update(i % 2 == 0 ? 0.0025F : 0.0045F), ContactAction::slide);
    }
    EXPECT_EQ(update(0.0015F), ContactAction::release);
    EXPECT_EQ(update(0.003F), ContactAction::rest);
}

/// A tip on a surface, 90 times a second.
class PlacedTip {
public:
    /// Tells the places that a function of time gives. Returns the number of frames in which the tip slides.
    template <typename Place>
    int move(double seconds, double speedMps, Place&& placeMetres) {
        int frames = 0;
        for (int frame = 0; frame < static_cast<int>(seconds * 90.0); ++frame) {
            now_ += 1.0 / 90.0;
            const double metres = 1.0 + placeMetres(static_cast<double>(frame) / 90.0);
            (void)follower_.update(testing::slidingAt(metres, static_cast<float>(speedMps)), now_);
            frames += slides() ? 1 : 0;
        }
        return frames;
    }
    int stroke(double seconds, double speedMps) {
        return move(seconds, speedMps, [speedMps](double t) { return speedMps * t; });
    }
    int hold(double seconds, double speedMps, double metres = 0.0) {
        return move(seconds, speedMps, [metres](double) { return metres; });
    }
    /// About a place, at 9 Hz.
    int tremble(double seconds, double amplitudeMetres, double metres = 0.0) {
        constexpr double angularHz = 2.0 * std::numbers::pi * 9.0;
        return move(seconds, angularHz * amplitudeMetres,
                    [&](double t) { return metres + amplitudeMetres * std::sin(angularHz * t); });
    }
    [[nodiscard]] bool slides() const { return follower_.sliding(); }

private:
    ContactFollower follower_;
    double now_ = 0.0;
};

TEST(ContactFollowerPlaceTest, AHeldTipThatTremblesFasterThanItCreepsNeverSlides) {
    for (const double amplitude : {0.00002, 0.0002, 0.00049}) {
        EXPECT_EQ(PlacedTip().tremble(20.0, amplitude), 0) << amplitude;
    }
}

TEST(ContactFollowerPlaceTest, ACreepingTipSlidesAfterAMillimetreAndGoesOn) {
    for (const double speed : {0.001, 0.002, 0.003, 0.01}) {
        EXPECT_NEAR(PlacedTip().stroke(5.0, speed), 450.0 - 90.0 * 0.001 / speed, 3.0) << speed;
    }
}

TEST(ContactFollowerPlaceTest, AStrokeSlidesInItsSecondFrameAndATouchAtSpeedAtOnce) {
    PlacedTip tip;
    (void)tip.hold(0.5, 0.0);
    EXPECT_EQ(tip.stroke(2.01 / 90.0, 0.1), 1);
    EXPECT_EQ(PlacedTip().hold(1.01 / 90.0, 0.1), 1);
    EXPECT_EQ(PlacedTip().hold(1.01 / 90.0, 0.01), 0);
}

TEST(ContactFollowerPlaceTest, AStopEndsSlidingAtOnceAndAStopWithTremorWithinTheHold) {
    PlacedTip tip;
    (void)tip.stroke(0.5, 0.1);
    ASSERT_TRUE(tip.slides());
    EXPECT_EQ(tip.hold(0.2, 0.0, 0.049), 0);
    PlacedTip trembling;
    (void)trembling.stroke(0.5, 0.1);
    EXPECT_LE(trembling.tremble(3.0, 0.0003, 0.049), 0.15 * 90.0 + 4.0);
    EXPECT_FALSE(trembling.slides());
}

TEST(ContactFollowerPlaceTest, AReversalAtTheSpeedOfHandwritingIsOneStroke) {
    for (const double speed : {0.01, 0.027, 0.1, 0.5}) {
        PlacedTip tip;
        (void)tip.stroke(1.0, speed);
        ASSERT_TRUE(tip.slides());
        EXPECT_EQ(tip.move(1.0, speed, [speed](double t) { return speed * (1.0 - t); }), 90) << speed;
    }
}

}  // namespace
}  // namespace haptoflow::engine
