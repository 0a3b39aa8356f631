#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// A sine whose frequency rises exponentially: all octaves take the same time, and deconvolution separates an
/// actuator's distortion from its response (A. Farina, "Simultaneous measurement of impulse response and distortion
/// with a swept-sine technique", AES 108, 2000).
struct ExponentialSweep {
    static constexpr double silenceSeconds = 1.0;
    /// Length of the fade at either end of the sweep's range; the measured range lies between.
    static constexpr double fadeOctaves = 0.1;

    double seconds = 10.0;
    double fromHz = 20.0;
    double toHz = 1200.0;
    /// Amplitude, a share of full scale.
    double level = 0.25;

    /// Time in which the frequency rises by a factor of e.
    [[nodiscard]] double secondsPerNeper() const;
    /// The sweep alone, without the silence after it.
    [[nodiscard]] std::vector<float> samples(double rateHz) const;
    /// A line of text with the sweep's parameters, which `parse` reads.
    [[nodiscard]] std::string describe() const;
    /// Empty if the text does not describe a sweep, or its parameters are not valid.
    [[nodiscard]] static std::optional<ExponentialSweep> parse(std::string_view text);
};

}  // namespace haptoflow::cli
