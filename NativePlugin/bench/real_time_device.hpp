#pragma once

#include "bench/bench_plan.hpp"
#include "bench/recording.hpp"

#include <atomic>
#include <functional>
#include <span>
#include <thread>

namespace haptoflow::bench {

/// An audio device without a sound card: a thread that calls back in real time and keeps what it is given. What a block
/// that is asked for at a time holds, plays from that time on; the buffers of a driver and the digital-to-analogue
/// converter come on top, and are the same for every program.
class RealTimeDevice {
public:
    /// Fills the span; on the device's thread.
    using Callback = std::function<void(std::span<float>)>;

    /// Starts at once and stops by itself after `longestSeconds`, for which it keeps room. What the callback names must
    /// outlive the device. Throws std::system_error where no thread can be made.
    RealTimeDevice(const DeviceShape& shape, double longestSeconds, Callback callback);
    RealTimeDevice(const RealTimeDevice&) = delete;
    RealTimeDevice& operator=(const RealTimeDevice&) = delete;
    ~RealTimeDevice();

    /// Ends the stream and hands over what was played. Once.
    [[nodiscard]] Recording finish();

private:
    void run();
    void renderBlock(double playsAtSeconds);

    DeviceShape shape_;
    Callback callback_;
    Recording recording_;
    std::size_t written_ = 0;
    std::atomic<bool> stopping_{false};
    std::thread thread_;
};

}  // namespace haptoflow::bench
