#pragma once

#include "bench/bench_plan.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace haptoflow::bench {

/// One callback, and the time at which its first sample plays.
struct PlayedBlock {
    double playsAtSeconds = 0.0;
    std::size_t firstFrame = 0;
    std::size_t frames = 0;
};

/// The signal that a simulated device played, with the time of each sample. All times are those of `nowSeconds`; a
/// search between two times excludes the second one.
struct Recording {
    double rateHz = outputRateHz;
    std::vector<PlayedBlock> blocks;
    std::vector<float> samples;
    /// Callbacks that came more than half a period late, because the machine was busy with other work.
    std::size_t lateCalls = 0;

    /// The largest magnitude between two times; 0 if there are no samples.
    [[nodiscard]] float peak(double fromSeconds, double toSeconds) const;
    /// The times of the first and the last sample of at least this magnitude.
    [[nodiscard]] std::optional<double> first(float magnitude, double fromSeconds, double toSeconds) const;
    [[nodiscard]] std::optional<double> last(float magnitude, double fromSeconds, double toSeconds) const;
};

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
