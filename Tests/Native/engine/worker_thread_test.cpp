#include "engine/worker_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <thread>

namespace haptoflow::engine {
namespace {

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
