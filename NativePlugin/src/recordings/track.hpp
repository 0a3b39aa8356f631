#pragma once

#include "recordings/recording_table.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::recordings {

/// Numbers at increasing times; `width` numbers for each time.
struct Track {
    std::vector<double> timeSeconds;
    std::vector<double> values;
    std::size_t width = 1;
    /// Line of each time in its file, for messages; empty for WAV.
    std::vector<std::uint32_t> lines;

    [[nodiscard]] std::size_t count() const { return timeSeconds.size(); }
    [[nodiscard]] std::span<const double> at(std::size_t index) const {
        return std::span(values).subspan(index * width, width);
    }
};

/// The rows of a series that have a time and all of their numbers, without repeated times, of which 1 % are accepted.
/// Throws RecordingUnusable that names file and line if time runs back, and if fewer than 4 rows are left.
[[nodiscard]] Track trackOf(const RecordingTable& table, const TableSeries& series);

/// The median of the steps between a track's times; of two in the middle the larger.
[[nodiscard]] double medianStepSeconds(const Track& track);

/// Samples a second: the mean over all steps but gaps, because times are often written with few digits; the roundest
/// number that these allow, whose error is at most `roundingSeconds`.
[[nodiscard]] double rateOf(const Track& track, double roundingSeconds);

/// Even times where the track's own differ from them by no more than `roundingSeconds`; otherwise its own. A sensor
/// whose clock is even would seem to tremble by the digits of its time stamps.
[[nodiscard]] Track withoutRounding(Track track, double rateHz, double roundingSeconds);

/// The longest step between samples that belong together, in s; a longer one is a gap.
[[nodiscard]] double longestStepSeconds(double rateHz);

/// Looks up positions along a track for increasing times.
class Cursor {
public:
    explicit Cursor(const Track& track) : track_(track) {}

    /// The index of the last reading at or before the time, limited so that another reading follows.
    std::size_t before(double seconds);

    [[nodiscard]] double linear(std::size_t index, std::size_t column, double seconds) const;

    /// A cubic through the four nearest readings, for uneven time stamps well above the signal's band.
    [[nodiscard]] double cubic(std::size_t index, std::size_t column, double seconds) const;

private:
    const Track& track_;
    std::size_t at_ = 0;
};

/// The readings at which the tracker measured a new value: rows that repeat an older reading would look like rests and
/// jumps. Readings of a tip at rest are kept.
[[nodiscard]] Track readAnew(const Track& track);

/// The velocity, of width 2 in m/s; a speed lies along the first axis. From positions it is the slope of a cubic fitted
/// to 90 ms of evenly spaced readings (Savitzky-Golay), which averages out the tracker's resolution and has no bias at
/// constant speed or acceleration.
[[nodiscard]] Track velocityOf(const Track& motion, MotionForm form);

}  // namespace haptoflow::recordings
