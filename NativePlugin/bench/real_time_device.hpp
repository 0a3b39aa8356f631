#pragma once

#include "bench/bench_plan.hpp"
#include "bench/recording.hpp"

#include <atomic>
#include <functional>
#include <span>
#include <thread>

namespace haptoflow::bench {

/// An audio device without a sound card: a thread that calls back in real time and keeps the rendered blocks. A block
/// requested at a time counts as playing from that time on; the delays of a driver's buffers and of the
/// digital-to-analogue converter are added to that and are the same for every program.
class RealTimeDevice {
public:
    /// Fills the span; called on the device's thread.
    using Callback = std::function<void(std::span<float>)>;

    /// Starts at once and stops by itself after `maximumSeconds`, for which it allocates memory. The objects that the
    /// callback uses must outlive the device. Throws std::system_error if no thread can be created.
    RealTimeDevice(const DeviceShape& shape, double maximumSeconds, Callback callback);
    RealTimeDevice(const RealTimeDevice&) = delete;
    RealTimeDevice& operator=(const RealTimeDevice&) = delete;
    ~RealTimeDevice();

    /// Stops the device and returns what it played. Call it once.
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
