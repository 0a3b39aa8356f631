#include "engine/waveform.hpp"

#include "engine/mailbox.hpp"
#include "engine/worker_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <thread>
#include <vector>

// What a network adds to a stream: here to one of zeros, so that the corrections alone are heard.

namespace haptoflow::engine {
namespace {

skeleton::StreamParameters atLevel(float levelMps2) {
    skeleton::StreamParameters parameters;
    parameters.levelMps2 = levelMps2;
    return parameters;
}

Waveform begun(float levelMps2 = 1.0F) {
    Waveform waveform;
    waveform.begin(atLevel(levelMps2), 0.0, {});
    return waveform;
}

std::vector<float> readSamples(Waveform& waveform, std::size_t count) {
    std::vector<float> samples(count);
    waveform.read(nullptr, samples);
    return samples;
}

Correction constant(std::int64_t start, float value) {
    Correction correction{.start = start};
    correction.unit.fill(value);
    return correction;
}

/// From `first` on, rising by 1 from sample to sample.
Correction counting(std::int64_t start, float first) {
    Correction correction{.start = start};
    for (std::size_t i = 0; i < correction.unit.size(); ++i) {
        correction.unit[i] = first + static_cast<float>(i);
    }
    return correction;
}

TEST(WaveformTest, ACorrectionThatContinuesTheRunningOneChangesNothing) {
    Waveform waveform = begun();
    ASSERT_EQ(waveform.take(counting(waveform.head(), 1.0F)), waveform.head());
    (void)readSamples(waveform, 20);
    ASSERT_EQ(waveform.take(counting(waveform.head() + 30, 51.0F)), waveform.head() + 30);
    const std::vector<float> output = readSamples(waveform, 150);
    for (std::size_t i = 0; i < output.size(); ++i) {
        ASSERT_FLOAT_EQ(output[i], 21.0F + static_cast<float>(i)) << i;
    }
}

TEST(WaveformTest, AnotherCorrectionTakesOverWithinFourSamples) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    (void)readSamples(waveform, 20);
    (void)waveform.take(constant(waveform.head() + 5, -1.0F));
    const std::vector<float> output = readSamples(waveform, 20);
    EXPECT_EQ(output[4], 1.0F);
    for (std::size_t i = 5; i < 9; ++i) {
        EXPECT_LT(output[i], output[i - 1]) << i;
        EXPECT_GT(output[i], -1.0F) << i;
    }
    EXPECT_EQ(output[9], -1.0F);
}

TEST(WaveformTest, AShorterRemainderOfTheOldCorrectionIsNotHeardBehindTheNewOne) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head() + 150, 1.0F));
    (void)waveform.take(constant(waveform.head(), 2.0F));
    EXPECT_EQ(waveform.correctedUntil(), waveform.head() + 200);
    EXPECT_EQ(readSamples(waveform, 320).back(), 0.0F);
}

TEST(WaveformTest, ALateCorrectionLosesTheSamplesThatTheHeadHasPassed) {
    Waveform waveform = begun();
    const std::int64_t start = waveform.head() + 10;
    (void)readSamples(waveform, 25);
    EXPECT_EQ(waveform.take(counting(start, 1000.0F)), waveform.head());
    EXPECT_EQ(waveform.correctedUntil(), start + 200);
    EXPECT_EQ(readSamples(waveform, 20)[10], 1025.0F);
}

TEST(WaveformTest, ACorrectionWhollyInThePastOrTooFarAheadIsRejected) {
    Waveform waveform = begun();
    const std::int64_t start = waveform.head();
    (void)readSamples(waveform, 200);
    EXPECT_EQ(waveform.take(constant(start, 9.0F)), -1);
    EXPECT_EQ(waveform.take(constant(waveform.head() + Waveform::aheadSamples, 9.0F)), -1);
    EXPECT_EQ(waveform.correctedUntil(), start);
    EXPECT_EQ(readSamples(waveform, 100).back(), 0.0F);
}

TEST(WaveformTest, WithoutANewCorrectionTheLastOneFadesOverFiveMilliseconds) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    EXPECT_TRUE(waveform.isCorrected());
    const std::vector<float> output = readSamples(waveform, 260);
    EXPECT_EQ(output[189], 1.0F);
    for (std::size_t i = 190; i < output.size(); ++i) {
        ASSERT_LE(std::abs(output[i] - output[i - 1]), 0.1001F) << i;
    }
    EXPECT_EQ(output[200], 0.0F);
    EXPECT_FALSE(waveform.isCorrected());
}

TEST(WaveformTest, WhereAnotherIsExpectedACorrectionDoesNotFadeBefore) {
    for (const std::int64_t until : {200, 195}) {
        Waveform waveform = begun();
        (void)waveform.take(constant(waveform.head(), 1.0F));
        waveform.expect(waveform.head() + until);
        EXPECT_EQ(readSamples(waveform, static_cast<std::size_t>(until)).back(), 1.0F) << until;
    }
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    waveform.expect(waveform.head() + 201);
    EXPECT_NEAR(readSamples(waveform, 200).back(), 0.1F, 1e-6F) << "behind a gap";
}

TEST(WaveformTest, ACorrectionDuringThatFadeRisesAgainWithoutAStep) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    (void)readSamples(waveform, 195);
    (void)waveform.take(constant(waveform.head(), 1.0F));
    const std::vector<float> output = readSamples(waveform, 30);
    EXPECT_NEAR(output[0], 0.6F, 0.15F);
    for (std::size_t i = 1; i < output.size(); ++i) {
        ASSERT_LE(std::abs(output[i] - output[i - 1]), 0.1001F) << i;
    }
    EXPECT_EQ(output.back(), 1.0F);
}

TEST(WaveformTest, ACorrectionBehindAGapLetsTheOneBeforeFadeAtItsEnd) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    (void)waveform.take(constant(waveform.head() + 230, 1.0F));
    const std::vector<float> output = readSamples(waveform, 260);
    EXPECT_EQ(output[189], 1.0F);
    EXPECT_EQ(output[215], 0.0F);
    EXPECT_EQ(output[240], 1.0F);
    for (std::size_t i = 180; i < 225; ++i) {
        ASSERT_LE(std::abs(output[i] - output[i - 1]), 0.1001F) << i;
    }
}

TEST(WaveformTest, CorrectionsFollowTheStreamsLevel) {
    Waveform waveform = begun();
    (void)waveform.take(constant(waveform.head(), 1.0F));
    (void)readSamples(waveform, 50);
    waveform.follow(atLevel(4.0F), 0.0);
    const std::vector<float> output = readSamples(waveform, 20);
    EXPECT_GT(output[0], 1.0F);
    EXPECT_LT(output[0], 2.0F);
    EXPECT_NEAR(output[4], 4.0F, 1e-4F);
}

TEST(WaveformTest, ThePastIsWhatWasPlayedAndZeroBeforeTheBeginning) {
    Waveform waveform = begun(2.0F);
    (void)waveform.take(counting(waveform.head(), 100.0F));
    (void)readSamples(waveform, 150);
    std::array<float, inference::segmentSamples> past{};
    waveform.past(past);
    EXPECT_EQ(past[49], 0.0F);
    EXPECT_FLOAT_EQ(past[60], 220.0F);
    EXPECT_FLOAT_EQ(past.back(), 498.0F);
    waveform.begin(atLevel(1.0F), 0.0, {});
    waveform.past(past);
    EXPECT_EQ(past.back(), 0.0F);
    EXPECT_EQ(readSamples(waveform, 10).back(), 0.0F) << "corrections of the stream before are gone";
}

TEST(WaveformTest, ACopyReadsOnAsTheOriginalDoes) {
    Waveform waveform = begun();
    (void)waveform.take(counting(waveform.head() + 3, -50.0F));
    (void)readSamples(waveform, 37);
    Waveform copy = waveform;
    EXPECT_EQ(readSamples(copy, 200), readSamples(waveform, 200));
}

struct Message {
    std::uint64_t number = 0;
    std::array<std::uint64_t, 64> copies{};
};

TEST(MailboxTest, OnlyTheNewestMessageIsFetchedAndOnlyOnce) {
    Mailbox<int> mailbox;
    EXPECT_FALSE(mailbox.fetch());
    for (const int number : {1, 2, 3}) {
        mailbox.draft() = number;
        mailbox.post();
    }
    EXPECT_TRUE(mailbox.fetch());
    EXPECT_EQ(mailbox.current(), 3);
    EXPECT_FALSE(mailbox.fetch());
    EXPECT_EQ(mailbox.current(), 3);
}

TEST(MailboxTest, AConcurrentReaderNeverGetsAHalfWrittenOrOlderMessage) {
    Mailbox<Message> mailbox;
    constexpr std::uint64_t count = 20000;
    std::thread writer([&mailbox] {
        for (std::uint64_t number = 1; number <= count; ++number) {
            Message& draft = mailbox.draft();
            draft.number = number;
            draft.copies.fill(number);
            mailbox.post();
        }
    });
    std::uint64_t last = 0;
    bool isWhole = true;
    while (last < count) {
        if (!mailbox.fetch()) {
            std::this_thread::yield();
            continue;
        }
        const Message& message = mailbox.current();
        isWhole = isWhole && message.number > last &&
                  std::ranges::all_of(message.copies, [&](std::uint64_t copy) { return copy == message.number; });
        last = message.number;
    }
    writer.join();
    EXPECT_TRUE(isWhole);
}

TEST(CorrectionQueueTest, CorrectionsKeepTheirOrderAndAFullQueueRejects) {
    CorrectionQueue queue;
    EXPECT_EQ(queue.front(), nullptr);
    Correction correction;
    for (std::uint64_t sequence = 1; sequence <= CorrectionQueue::capacity; ++sequence) {
        correction.sequence = sequence;
        EXPECT_TRUE(queue.push(correction));
    }
    EXPECT_EQ(queue.room(), 0U);
    EXPECT_FALSE(queue.push(correction));
    for (std::uint64_t sequence = 1; sequence <= CorrectionQueue::capacity; ++sequence) {
        ASSERT_NE(queue.front(), nullptr);
        EXPECT_EQ(queue.front()->sequence, sequence);
        queue.pop();
    }
    EXPECT_EQ(queue.front(), nullptr);
}

TEST(CorrectionQueueTest, NoCorrectionIsLostOrTornBetweenTwoThreads) {
    CorrectionQueue queue;
    constexpr std::uint64_t count = 20000;
    std::thread writer([&queue] {
        Correction correction;
        for (std::uint64_t sequence = 1; sequence <= count; ++sequence) {
            correction.sequence = sequence;
            correction.unit.fill(static_cast<float>(sequence));
            while (!queue.push(correction)) {
                std::this_thread::yield();
            }
        }
    });
    bool isWhole = true;
    for (std::uint64_t expected = 1; expected <= count; ++expected) {
        const Correction* correction = queue.front();
        while (correction == nullptr) {
            std::this_thread::yield();
            correction = queue.front();
        }
        isWhole = isWhole && correction->sequence == expected &&
                  correction->unit.front() == static_cast<float>(expected) &&
                  correction->unit.back() == static_cast<float>(expected);
        queue.pop();
    }
    writer.join();
    EXPECT_TRUE(isWhole);
}

double millisecondsOf(auto&& action) {
    const auto began = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - began).count();
}

TEST(WakeSignalTest, AWaitOfTwoMillisecondsTakesTwoAndNotTheTickOfTheSystemsTimer) {
    WakeSignal signal;
    std::array<double, 41> waits{};
    for (double& wait : waits) {
        wait = millisecondsOf([&] { EXPECT_FALSE(signal.waitFor(2.0)); });
    }
    std::ranges::sort(waits);
    EXPECT_GE(waits.front(), 1.9);
    EXPECT_LT(waits[waits.size() / 2], 4.0) << "the median";
}

TEST(WakeSignalTest, AFractionOfAMillisecondIsWaitedFor) {
    WakeSignal signal;
    const double spent = millisecondsOf([&] {
        for (int i = 0; i < 10; ++i) {
            EXPECT_FALSE(signal.waitFor(0.5));
        }
    });
    EXPECT_GE(spent, 4.5);
}

TEST(WakeSignalTest, APostEndsAWaitAndSeveralCountAsOne) {
    WakeSignal signal;
    signal.post();
    signal.post();
    EXPECT_TRUE(signal.waitFor(1000.0));
    EXPECT_FALSE(signal.waitFor(1.0));
    std::thread other([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        signal.post();
    });
    EXPECT_LT(millisecondsOf([&] { EXPECT_TRUE(signal.waitFor(60'000.0)); }), 5'000.0);
    other.join();
    // A wait that ended early leaves nothing behind that ends the next one.
    EXPECT_GE(millisecondsOf([&] { EXPECT_FALSE(signal.waitFor(20.0)); }), 19.0);
}

}  // namespace
}  // namespace haptoflow::engine
