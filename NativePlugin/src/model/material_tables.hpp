#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::model {

/// Where a value lies in a rising list, in logarithms: between `lower` and the next, by `share`; held at the ends.
struct LogPlace {
    std::size_t lower = 0;
    double share = 0.0;
};

/// `rising` holds at least one number, all above 0.
[[nodiscard]] LogPlace placeInLog(std::span<const double> rising, double value) noexcept;

/// A label's own level, used instead of the level graph's.
struct LevelTable {
    static constexpr std::size_t maximumSpeeds = 16;
    /// Added to a speed before its logarithm is taken, so that rest has one.
    static constexpr double restMps = 0.0005;
    /// Weaker forces count as this one.
    static constexpr double weakestNewtons = 0.02;

    /// Rising; at least one.
    std::vector<double> speedsMps;
    /// Natural logarithm of the RMS in m/s^2 before tone at each speed, at `forceNewtons`.
    std::vector<double> logLevels;
    double forceNewtons = 1.0;
    double forceExponent = 0.0;

    /// What the table's speeds are interpolated over.
    [[nodiscard]] static double logSpeed(double speedMps) noexcept;
    /// Straight lines in `logSpeed` between the table's speeds, a power of that exponent beyond its ends; times a power
    /// of the force.
    [[nodiscard]] double logLevel(double speedMps, double newtons, double speedExponent) const noexcept;
};

/// What is done to a label's spectrum after it was generated.
struct ToneTable {
    static constexpr std::size_t maximumSpeeds = 8;
    static constexpr std::size_t minimumFrequencies = 2;
    static constexpr std::size_t maximumFrequencies = 32;
    /// Rising; at least one.
    std::vector<double> speedsMps;
    /// Rising.
    std::vector<double> frequenciesHz;
    /// For each speed the gain at each frequency.
    std::vector<std::vector<double>> gainsDb;

    /// Of the row of one speed: straight lines in log frequency, held at the ends.
    [[nodiscard]] double rowGainDb(std::size_t row, double frequencyHz) const noexcept;
    /// Straight lines in log speed between the rows; held at the ends.
    [[nodiscard]] double gainDb(double speedMps, double frequencyHz) const noexcept;
};

}  // namespace haptoflow::model
