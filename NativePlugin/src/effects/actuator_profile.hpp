#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::effects {

/// The text of a profile that is compiled in.
struct BuiltInProfile {
    std::string_view name;
    std::string_view json;
};

/// The files of NativePlugin/profiles; CMake generates the source file.
[[nodiscard]] std::span<const BuiltInProfile> builtInProfiles() noexcept;

/// A profile is invalid. The message is one line that names the key, the expected value and the value found.
class ProfileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// How an actuator was measured. For people to read: nothing is computed from it.
struct ActuatorMeasurement {
    double sampleRateHz = 0.0;
    /// From the sweep's first sample in the output to its first sample in the recording.
    double delaySeconds = 0.0;
    /// Total harmonic distortion, RMS over the measured band.
    double distortionPercent = 0.0;
    /// Median over the measured band.
    double signalToNoiseDecibels = 0.0;

    [[nodiscard]] bool operator==(const ActuatorMeasurement&) const = default;
};

/// The frequency response of an actuator: magnitude and, if known, phase. The JSON format is specified in
/// Documentation~ (devices.md, actuator-profile.schema.json). Any thread may read; parsing allocates.
struct ActuatorProfile {
    static constexpr int formatVersion = 1;
    static constexpr std::size_t maximumTextBytes = std::size_t{1} << 20U;
    static constexpr std::size_t maximumPoints = 4096;
    static constexpr double minimumFrequencyHz = 0.1;
    static constexpr double maximumFrequencyHz = 1e5;
    static constexpr double maximumMagnitudeDecibels = 200.0;

    std::string name;
    /// Source of the figures.
    std::string provenance;
    /// True if the figures are estimated and not measured on this actuator.
    bool isApproximate = false;
    /// Peak acceleration in m/s^2 at 0 dB for an output sample of 1; empty if not measured.
    std::optional<double> ratedLevelMps2;
    /// Strictly increasing.
    std::vector<double> frequencyHz;
    /// One per frequency.
    std::vector<double> magnitudeDecibels;
    /// One per frequency, or empty for a minimum-phase response.
    std::vector<double> phaseDegrees;
    std::vector<double> resonancesHz;
    std::optional<ActuatorMeasurement> measurement;

    /// Parses and validates an untrusted profile. Throws ProfileError.
    [[nodiscard]] static ActuatorProfile parse(std::string_view json);
    /// JSON text that `parse` reads back.
    [[nodiscard]] std::string toJson() const;

    /// The built-in profile of that name, or none.
    [[nodiscard]] static std::optional<ActuatorProfile> builtIn(std::string_view name);

    [[nodiscard]] bool operator==(const ActuatorProfile&) const = default;

    /// Linear interpolation over the logarithm of frequency; constant beyond the ends.
    [[nodiscard]] double magnitudeDecibelsAt(double hz) const noexcept;
};

}  // namespace haptoflow::effects
