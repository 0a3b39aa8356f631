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

/// A profile was refused. The message is one line that names the key, what was expected there and what was found.
class ProfileError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// How an actuator was measured. All of it is for people to read; nothing is computed from it.
struct ActuatorMeasurement {
    double sampleRateHz = 0.0;
    /// From the sweep's first sample in the output to its first in the recording.
    double delaySeconds = 0.0;
    /// Total harmonic distortion, root mean square over the measured band.
    double distortionPercent = 0.0;
    /// Median over the measured band.
    double signalToNoiseDecibels = 0.0;

    [[nodiscard]] bool operator==(const ActuatorMeasurement&) const = default;
};

/// What an actuator makes of a signal: magnitude and, where known, phase over frequency. Documentation~ specifies the
/// JSON (actuator-profile.md, actuator-profile.schema.json). Any thread may read; parsing allocates.
struct ActuatorProfile {
    static constexpr int formatVersion = 1;
    static constexpr std::size_t largestTextBytes = std::size_t{1} << 20U;
    static constexpr std::size_t mostPoints = 4096;
    static constexpr double lowestFrequencyHz = 0.1;
    static constexpr double highestFrequencyHz = 1e5;
    static constexpr double largestMagnitudeDecibels = 200.0;

    std::string name;
    /// Where the figures come from.
    std::string provenance;
    /// True where the figures are an estimate and not a measurement of this actuator.
    bool isApproximate = false;
    /// Peak acceleration, m/s^2, at 0 dB for an output sample of 1; none where nobody measured it.
    std::optional<double> ratedLevelMps2;
    /// Strictly rising.
    std::vector<double> frequencyHz;
    /// One for each frequency.
    std::vector<double> magnitudeDecibels;
    /// One for each frequency, or none: the response is taken as minimum-phase then.
    std::vector<double> phaseDegrees;
    std::vector<double> resonancesHz;
    std::optional<ActuatorMeasurement> measurement;

    /// Reads a profile that nobody vouches for. Throws ProfileError.
    [[nodiscard]] static ActuatorProfile parse(std::string_view json);
    /// The profile as JSON that `parse` reads.
    [[nodiscard]] std::string toJson() const;

    /// The built-in profile of that name, or none.
    [[nodiscard]] static std::optional<ActuatorProfile> builtIn(std::string_view name);

    [[nodiscard]] bool operator==(const ActuatorProfile&) const = default;

    /// On straight lines over the logarithm of frequency; beyond the ends, the end's value.
    [[nodiscard]] double magnitudeDecibelsAt(double hz) const noexcept;
};

}  // namespace haptoflow::effects
