#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::clips {

/// A clip was refused. The message names the key and what was expected.
class ClipError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A point of a curve that is linear between its points and level before the first and after the last.
struct ClipPoint {
    double seconds = 0.0;
    double value = 0.0;
};

/// A short, sudden pulse: a tap or an edge.
struct ClipTransient {
    double seconds = 0.0;
    /// Share of the device's range, 0 to 1.
    double amplitude = 0.0;
    double frequencyHz = 0.0;
};

/// What a clip says of its origin. Texts without control characters.
struct ClipOrigin {
    std::string title{};
    /// What was rendered: materials, speed and force, model and seed.
    std::string description{};
    /// The program that wrote it.
    std::string editor{};
    std::string author{};
    /// The file or recording that it was made from.
    std::string source{};
    std::vector<std::string> tags{};
};

/// A vibration as the tools of the field describe one: amplitude and frequency of a carrier over time, and transients.
struct HapticClip {
    static constexpr double longestSeconds = 600.0;
    static constexpr std::size_t mostPoints = 1'000'000;
    static constexpr std::size_t mostTransients = 20'000;

    double durationSeconds = 0.0;
    /// Shares of the device's range, 0 to 1. The times of a curve do not fall; two equal ones are a jump.
    std::vector<ClipPoint> amplitude{};
    /// Above 0. Empty where the clip leaves the frequency to the device.
    std::vector<ClipPoint> frequencyHz{};
    /// In the order of time. Their energy is not in the amplitude.
    std::vector<ClipTransient> transients{};
    ClipOrigin origin{};
};

/// Reads a curve at times that do not fall: each read costs the points passed since the last.
class CurveReader {
public:
    /// `outside` is the value of a curve without points. The points must outlive the reader.
    CurveReader(std::span<const ClipPoint> points, double outside) noexcept : points_(points), outside_(outside) {}

    /// Of two points at one time, the second.
    [[nodiscard]] double at(double seconds) noexcept;

private:
    std::span<const ClipPoint> points_;
    double outside_;
    std::size_t next_ = 0;
};

[[nodiscard]] double valueAt(std::span<const ClipPoint> points, double seconds, double outside) noexcept;

/// How long a transient is played. MPEG-I's reference software (Band) does so, with two cycles whatever the frequency.
inline constexpr double pulseSeconds = 0.022;

/// Carrier of a clip that names no frequency, and of its transients.
inline constexpr double usualFrequencyHz = 160.0;

/// What a device with this range of frequencies plays of a clip, +-1, `rateHz` (2 to 192 kHz) samples a second from the
/// clip's start to its end: the carrier, whose phase is continuous, and each transient as a pulse of its frequency.
/// Throws std::invalid_argument for a rate or range out of bounds. Allocates.
[[nodiscard]] std::vector<float> playedWave(const HapticClip& clip, double rateHz, double minFrequencyHz = 1.0,
                                            double maxFrequencyHz = 1000.0);

/// The clip as a vibration in m/s^2: `playedWave` with the loudness law of devices with amplitude and frequency
/// undone, so that it can be added to a texture.
[[nodiscard]] std::vector<float> waveOf(const HapticClip& clip, double rateHz);

}  // namespace haptoflow::clips
