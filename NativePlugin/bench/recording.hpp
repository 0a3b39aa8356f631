#pragma once

#include "bench/bench_plan.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace haptoflow::bench {

/// One callback: the time at which its first sample plays, and how long the callback took.
struct PlayedBlock {
    double playsAtSeconds = 0.0;
    double renderSeconds = 0.0;
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

}  // namespace haptoflow::bench
