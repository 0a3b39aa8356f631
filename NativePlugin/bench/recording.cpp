#include "bench/recording.hpp"

#include <algorithm>
#include <cmath>

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

}  // namespace haptoflow::bench
