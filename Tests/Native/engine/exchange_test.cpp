#include "engine/worker_thread.hpp"

#include "engine/mailbox.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

namespace haptoflow::engine {
namespace {

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
