#pragma once

#include "bench/bench_plan.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace haptoflow::bench {

/// One callback: when its first sample plays, and how long it took.
struct PlayedBlock {
    double playsAtSeconds = 0.0;
    double renderSeconds = 0.0;
    std::size_t firstFrame = 0;
    std::size_t frames = 0;
};

/// What a simulated device was given to play, and when each sample of it plays. All times are those of `nowSeconds`;
/// a search from one time to another leaves the second out.
struct Recording {
    double rateHz = outputRateHz;
    std::vector<PlayedBlock> blocks;
    std::vector<float> samples;
    /// Callbacks that came more than half a period late: the machine had something else to do.
    std::size_t lateCalls = 0;

    /// The largest magnitude that plays between two times; 0 where nothing does.
    [[nodiscard]] float peak(double fromSeconds, double toSeconds) const;
    /// When the first or last sample of at least this magnitude plays.
    [[nodiscard]] std::optional<double> first(float magnitude, double fromSeconds, double toSeconds) const;
    [[nodiscard]] std::optional<double> last(float magnitude, double fromSeconds, double toSeconds) const;
};

}  // namespace haptoflow::bench
