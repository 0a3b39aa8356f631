#pragma once

#include "engine/quality_control.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace haptoflow::bench {

/// Receives the completed share of a measurement, 0 to 1.
using Advance = std::function<void(double share)>;

/// Time in seconds of the monotonic clock that all measurements use.
[[nodiscard]] inline double nowSeconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Sleeps until `nowSeconds` has reached `seconds`.
inline void sleepUntil(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto sinceEpoch = std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    std::this_thread::sleep_until(Clock::time_point(sinceEpoch));
}

/// Runs `action` and returns the time that it took, in seconds.
template <typename Action>
[[nodiscard]] double secondsOf(Action&& action) {
    const auto began = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

inline constexpr double outputRateHz = 48000.0;
/// Contact states per second of the simulated headset.
inline constexpr double updateRateHz = engine::defaultUpdateRateHz;
/// The block length of measurements that use a single one.
inline constexpr std::size_t defaultBlockFrames = 256;

/// Block length and burst length of an audio device.
struct DeviceShape {
    std::size_t blockFrames = defaultBlockFrames;
    /// Number of callbacks that follow each other immediately.
    std::size_t burstBlocks = 1;

    [[nodiscard]] double blockSeconds() const noexcept { return static_cast<double>(blockFrames) / outputRateHz; }
    /// Time from one burst to the next.
    [[nodiscard]] double periodSeconds() const noexcept { return blockSeconds() * static_cast<double>(burstBlocks); }
};

/// How much is measured. `events` scales all counts: more events take longer and give more reliable percentiles.
struct BenchPlan {
    std::size_t events = 120;
    /// The first device has the default block length and no bursts.
    std::vector<DeviceShape> devices{{256, 1}, {128, 1}, {512, 1}, {1024, 1}, {256, 2}, {1024, 2}};
    std::vector<std::size_t> callbackVoices{1, 2, 8};
    std::vector<std::size_t> batchVoices{1, 2, 4, 8, 16, 32, 64};

    /// All measurements, about three minutes.
    [[nodiscard]] static BenchPlan full() { return {}; }
    /// All measurements on three devices with fewer events, about half a minute.
    [[nodiscard]] static BenchPlan quick() {
        BenchPlan plan;
        plan.events = 24;
        plan.devices = {{256, 1}, {1024, 1}, {256, 2}};
        return plan;
    }

    [[nodiscard]] std::size_t callbackBlocks() const noexcept { return 20 * events; }
    [[nodiscard]] double callbackPacedSeconds() const noexcept { return 0.02 * static_cast<double>(events); }
    [[nodiscard]] std::size_t inferenceRuns() const noexcept { return 2 * events; }
    [[nodiscard]] std::size_t batchRuns() const noexcept { return std::max<std::size_t>(2, events / 5); }
    [[nodiscard]] double idleSeconds() const noexcept { return 0.02 * static_cast<double>(events); }
    [[nodiscard]] std::size_t loads() const noexcept { return std::max<std::size_t>(2, events / 10); }
};

/// Simulated time: calls `update(seconds)` whenever a contact state is due, and `block()` for each of `blocks` blocks
/// of the default device.
template <typename Update, typename Block>
void simulateBlocks(std::size_t blocks, Update&& update, Block&& block) {
    double nextUpdate = 0.0;
    for (std::size_t index = 0; index < blocks; ++index) {
        const double now = static_cast<double>(index) * DeviceShape{}.blockSeconds();
        if (now >= nextUpdate) {
            nextUpdate += 1.0 / updateRateHz;
            update(now);
        }
        block();
    }
}

}  // namespace haptoflow::bench
