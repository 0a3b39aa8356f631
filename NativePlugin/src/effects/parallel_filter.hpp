#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::effects {

/// Phase in radians, one value per point, of the minimum-phase system with the natural log magnitude `logMagnitude` at
/// frequencies `octavesPerPoint` apart. The magnitude is taken as constant beyond the ends. Allocates.
[[nodiscard]] std::vector<double> minimumPhaseRadians(std::span<const double> logMagnitude, double octavesPerPoint);

/// A point of the target response.
struct ResponsePoint {
    double frequencyHz = 0.0;
    std::complex<double> response = 1.0;
};

/// A direct path in parallel with second-order sections whose poles are spaced evenly over the logarithm of frequency.
/// The poles are fixed and the numerators are a linear least-squares fit, so the filter is stable for any response
/// (B. Bank, "Perceptually motivated audio equalization using fixed-pole parallel second-order filters", IEEE Signal
/// Processing Letters 15, 2008). The cost per sample is the same at every rate.
///
/// The first output sample depends on the first input sample. Non-finite input counts as 0; magnitudes are clamped to
/// 1e6.
class ParallelFilter {
public:
    static constexpr std::size_t sections = 24;
    static constexpr double lowestPoleHz = 25.0;
    static constexpr double highestPoleHz = 1600.0;

    /// Fits the filter to `points`, whose frequencies are below half the rate. Allocates: not on the audio thread.
    ParallelFilter(std::span<const ResponsePoint> points, double sampleRateHz);

    /// Response of the realised filter. Any thread.
    [[nodiscard]] std::complex<double> response(double frequencyHz) const noexcept;
    /// Multiplies the response by `factor`. Not while the filter runs.
    void scale(double factor) noexcept;
    /// Upper bound of the time in which the response to an input of at most `peak` decays below `silent`. Any thread.
    [[nodiscard]] double tailSeconds(double peak, double silent) const noexcept;

    /// Filters in place. Audio thread: allocates nothing, waits for nothing.
    void process(std::span<float> samples) noexcept;
    void reset() noexcept;
    /// Upper bound of the output that would follow without further input. Audio thread.
    [[nodiscard]] double envelope() const noexcept;

private:
    using Row = std::array<double, sections>;

    /// Amplitude of a section's free oscillation from these values of its two states.
    [[nodiscard]] double ringing(std::size_t section, double first, double second) const noexcept;

    double sampleRateHz_;
    double direct_ = 1.0;
    // One array per coefficient, so that the compiler can process several sections at once.
    Row in0_{};
    Row in1_{};
    Row back1_{};
    Row back2_{};
    Row state1_{};
    Row state2_{};
    // Radius, cosine and sine of the poles, for `ringing`.
    Row radius_{};
    Row cosine_{};
    Row sine_{};
};

}  // namespace haptoflow::effects
