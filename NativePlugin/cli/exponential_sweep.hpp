#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::cli {

/// A sine whose frequency rises exponentially: each octave lasts as long as any other, and after deconvolution what an
/// actuator distorts comes apart from what it plays (A. Farina, "Simultaneous measurement of impulse response and
/// distortion with a swept-sine technique", AES 108, 2000).
struct ExponentialSweep {
    static constexpr double silenceSeconds = 1.0;
    /// Of the sweep's range, at either end, that the fades take: what is measured lies between.
    static constexpr double fadeOctaves = 0.1;

    double seconds = 10.0;
    double fromHz = 20.0;
    double toHz = 1200.0;
    /// Amplitude, a share of full scale.
    double level = 0.25;

    /// By how much later a frequency e times higher comes.
    [[nodiscard]] double secondsPerNeper() const;
    /// The sweep alone, without the silence after it.
    [[nodiscard]] std::vector<float> samples(double rateHz) const;
    /// A line of text that `parse` reads.
    [[nodiscard]] std::string describe() const;
    /// None where the text is not a sweep's, or its figures make no sweep.
    [[nodiscard]] static std::optional<ExponentialSweep> parse(std::string_view text);
};

}  // namespace haptoflow::cli
