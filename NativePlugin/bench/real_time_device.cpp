#include "bench/real_time_device.hpp"

#include "engine/worker_thread.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::bench {
namespace {

/// Calls `visit(seconds, magnitude)` for every sample that plays between two times, in order.
template <typename Visit>
void visitPlaying(const Recording& recording, double fromSeconds, double toSeconds, Visit visit) {
    for (const PlayedBlock& block : recording.blocks) {
        const double ends = block.playsAtSeconds + static_cast<double>(block.frames) / recording.rateHz;
        if (ends < fromSeconds || block.playsAtSeconds >= toSeconds) {
            continue;
        }
        for (std::size_t frame = 0; frame < block.frames; ++frame) {
            const double seconds = block.playsAtSeconds + static_cast<double>(frame) / recording.rateHz;
            if (seconds >= fromSeconds && seconds < toSeconds) {
                visit(seconds, std::abs(recording.samples[block.firstFrame + frame]));
            }
        }
    }
}

}  // namespace

float Recording::peak(double fromSeconds, double toSeconds) const {
    float largest = 0.0F;
    visitPlaying(*this, fromSeconds, toSeconds,
                 [&largest](double, float magnitude) { largest = std::max(largest, magnitude); });
    return largest;
}

std::optional<double> Recording::first(float magnitude, double fromSeconds, double toSeconds) const {
    std::optional<double> found;
    visitPlaying(*this, fromSeconds, toSeconds, [&](double seconds, float value) {
        if (value >= magnitude && !found) {
            found = seconds;
        }
    });
    return found;
}

std::optional<double> Recording::last(float magnitude, double fromSeconds, double toSeconds) const {
    std::optional<double> found;
    visitPlaying(*this, fromSeconds, toSeconds, [&](double seconds, float value) {
        if (value >= magnitude) {
            found = seconds;
        }
    });
    return found;
}

RealTimeDevice::RealTimeDevice(const DeviceShape& shape, double maximumSeconds, Callback callback)
    : shape_(shape), callback_(std::move(callback)) {
    const auto bursts = static_cast<std::size_t>(std::ceil(maximumSeconds / shape.periodSeconds()));
    recording_.samples.resize(bursts * shape.burstBlocks * shape.blockFrames);
    recording_.blocks.reserve(bursts * shape.burstBlocks);
    thread_ = std::thread([this] { run(); });
}

RealTimeDevice::~RealTimeDevice() {
    stopping_ = true;
    if (thread_.joinable()) {
        thread_.join();
    }
}

Recording RealTimeDevice::finish() {
    stopping_ = true;
    thread_.join();
    recording_.samples.resize(written_);
    return std::move(recording_);
}

void RealTimeDevice::run() {
    engine::nameThisThread("device");
    // A host's audio thread has a raised priority, too. If the system refuses it, the thread runs without.
    (void)engine::raiseThisThreadsPriority();
    const double period = shape_.periodSeconds();
    double due = nowSeconds();
    while (!stopping_ && written_ < recording_.samples.size()) {
        due += period;
        sleepUntil(due);
        const double now = nowSeconds();
        recording_.lateCalls += now - due > 0.5 * period ? 1 : 0;
        // Like a driver, the device skips the blocks that it has missed.
        due = now - due > period ? now : due;
        for (std::size_t block = 0; block < shape_.burstBlocks; ++block) {
            renderBlock(now + static_cast<double>(block) * shape_.blockSeconds());
        }
    }
}

void RealTimeDevice::renderBlock(double playsAtSeconds) {
    const auto block = std::span(recording_.samples).subspan(written_, shape_.blockFrames);
    callback_(block);
    recording_.blocks.push_back({.playsAtSeconds = playsAtSeconds, .firstFrame = written_, .frames = block.size()});
    written_ += block.size();
}

}  // namespace haptoflow::bench
