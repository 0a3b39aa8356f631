#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::recordings {

/// No material can be learnt from a recording. The message names the reason and the remedy.
class RecordingUnusable : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A recording of one material, evenly sampled. The spans belong to the caller. A sample with a value that is not
/// finite excludes the samples around it.
struct Recording {
    double rateHz = 0.0;
    /// 1 or 3, interleaved.
    std::size_t axisCount = 1;
    /// m/s^2, with gravity or without.
    std::span<const float> accelerationMps2{};
    /// vx, vy in m/s for each sample; empty if the velocity is constant.
    std::span<const float> velocityMps{};
    std::array<double, 2> constantVelocityMps{};
    /// One for each sample; empty if the force is constant.
    std::span<const float> forceNewtons{};
    double constantForceNewtons = 0.0;

    [[nodiscard]] std::size_t sampleCount() const { return axisCount > 0 ? accelerationMps2.size() / axisCount : 0; }
    [[nodiscard]] double seconds() const { return static_cast<double>(sampleCount()) / rateHz; }
};

inline constexpr double gravityMps2 = 9.80665;
inline constexpr double lowestRateHz = 1000.0;
inline constexpr double highestRateHz = 192'000.0;
/// Maximum speed of a hand in m/s; a larger number is in another unit.
inline constexpr double maximumHandSpeedMps = 10.0;
/// Later samples are ignored.
inline constexpr double maximumSeconds = 300.0;
/// Recordings with less sliding are refused.
inline constexpr double minimumSlidingSeconds = 2.0;

/// A larger share of clipped samples has another spectrum.
inline constexpr double maximumClippedShare = 0.02;

/// The share of finite samples of one axis that stand at its largest or smallest value for several samples. `values`
/// begins with the axis; every `stride`th is its.
[[nodiscard]] double clippedShare(std::span<const float> values, std::size_t stride);

/// Speed at a sample in m/s.
[[nodiscard]] double speedAt(const Recording& recording, std::size_t sample);

/// The sum, over `count` samples from `first` on, of the squares of their difference from the sample before, on all
/// axes together: the difference of neighbours has neither gravity nor the hand's own motion. `first` is 1 or more.
[[nodiscard]] double squaredSteps(const Recording& recording, std::size_t first, std::size_t count);

/// Throws std::invalid_argument if the sizes of the spans do not match or a number is out of range.
void checkSizes(const Recording& recording);

/// Throws as checkSizes does, and RecordingUnusable if the samples are too short, silent, clipped or not finite.
void checkRecording(const Recording& recording);

/// The value below which `share` of one value or more lies.
[[nodiscard]] double quantile(std::vector<double> values, double share);

/// The middle value; of two in the middle the larger. One value or more.
[[nodiscard]] double upperMedian(std::vector<double> values);

/// Throws RecordingUnusable "PLACE: FOUND; expected EXPECTED".
[[noreturn]] void fail(const std::string& place, const std::string& found, const std::string& expected);

/// The words with commas between them, for messages.
[[nodiscard]] std::string joined(const std::vector<std::string>& words);

/// A number for messages: three significant digits with a decimal point, in every locale: "0.0823", "12.5", "1200".
[[nodiscard]] std::string plainNumber(double value);

}  // namespace haptoflow::recordings
