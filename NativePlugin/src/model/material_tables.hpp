#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::model {

/// The place of a value in an increasing list, on a logarithmic scale: between `lower` and the next entry, by `share`;
/// limited to the ends.
struct LogPlace {
    std::size_t lower = 0;
    double share = 0.0;
};

/// `rising` has at least one number, all above 0.
[[nodiscard]] LogPlace placeInLog(std::span<const double> rising, double value) noexcept;

/// A label's own level, which replaces that of the level graph.
struct LevelTable {
    static constexpr std::size_t maximumSpeeds = 16;
    /// Added to a speed before taking its logarithm, so that speed 0 has a finite one.
    static constexpr double restMps = 0.0005;
    /// Smaller forces are replaced by this one.
    static constexpr double minimumForceNewtons = 0.02;

    /// Increasing; at least one.
    std::vector<double> speedsMps;
    /// Natural logarithm of the RMS in m/s^2 before tone, for each speed at the force `forceNewtons`.
    std::vector<double> logLevels;
    double forceNewtons = 1.0;
    double forceExponent = 0.0;

    /// The variable over which the table's speeds are interpolated.
    [[nodiscard]] static double logSpeed(double speedMps) noexcept;
    /// Linear interpolation over `logSpeed` between the table's speeds, beyond its ends a power law with
    /// `speedExponent`; multiplied by a power of the force.
    [[nodiscard]] double logLevel(double speedMps, double newtons, double speedExponent) const noexcept;
};

/// Filter gains applied to a label's spectrum after it was generated.
struct ToneTable {
    static constexpr std::size_t maximumSpeeds = 8;
    static constexpr std::size_t minimumFrequencies = 2;
    static constexpr std::size_t maximumFrequencies = 32;
    static constexpr std::size_t maximumForces = 6;
    /// Increasing; at least one.
    std::vector<double> speedsMps;
    /// Increasing; one for a tone that is the same at every force.
    std::vector<double> forcesNewtons{1.0};
    /// Increasing.
    std::vector<double> frequenciesHz;
    /// Rows of gains, one for each frequency: those of all speeds at the first force, then those at the next.
    std::vector<std::vector<double>> gainsDb;

    /// Gain of one row: interpolated linearly over log frequency, constant beyond the ends.
    [[nodiscard]] double rowGainDb(std::size_t row, double frequencyHz) const noexcept;
    /// Gain interpolated linearly over log speed and log force between the rows, constant beyond the ends.
    [[nodiscard]] double gainDb(double speedMps, double newtons, double frequencyHz) const noexcept;
    /// The rows around a speed and a force, and their weights, which add up to 1.
    struct WeightedRow {
        std::size_t row = 0;
        double weight = 0.0;
    };
    [[nodiscard]] static std::array<WeightedRow, 4> rowsAround(std::span<const double> speedsMps,
                                                               std::span<const double> forcesNewtons, double speedMps,
                                                               double newtons) noexcept;
};

}  // namespace haptoflow::model
