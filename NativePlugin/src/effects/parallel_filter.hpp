#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace haptoflow::effects {

/// The phase, in radians, of the minimum-phase system whose natural log magnitude is `logMagnitude` at frequencies
/// `octavesPerPoint` apart; beyond the ends the magnitude stays the end's. One value a point. Allocates.
[[nodiscard]] std::vector<double> minimumPhaseRadians(std::span<const double> logMagnitude, double octavesPerPoint);

/// A point of the response that a filter is fitted to.
struct ResponsePoint {
    double frequencyHz = 0.0;
    std::complex<double> response = 1.0;
};

/// A direct path beside second-order sections whose poles lie evenly over the logarithm of frequency: the numerators
/// are a linear least-squares fit, so that any response fits, and no fit can make a pole unstable (B. Bank,
/// "Perceptually motivated audio equalization using fixed-pole parallel second-order filters", IEEE Signal Processing
/// Letters 15, 2008). The cost of a sample is the same at every rate.
///
/// The first sample out depends on the first sample in. What is not finite counts as 0, what is above 1e6 as 1e6.
class ParallelFilter {
public:
    static constexpr std::size_t sections = 24;
    static constexpr double lowestPoleHz = 25.0;
    static constexpr double highestPoleHz = 1600.0;

    /// Fits the filter to `points`, whose frequencies are below half of the rate. Any thread that can wait.
    ParallelFilter(std::span<const ResponsePoint> points, double sampleRateHz);

    /// The response as realised. Any thread.
    [[nodiscard]] std::complex<double> response(double frequencyHz) const noexcept;
    /// Multiplies the response. Not while the filter runs.
    void scale(double factor) noexcept;
    /// How long it takes until an input of `peak` has decayed below `silent`: a bound. Any thread.
    [[nodiscard]] double tailSeconds(double peak, double silent) const noexcept;

    /// In place. Audio thread: allocates nothing, waits for nothing.
    void process(std::span<float> samples) noexcept;
    void reset() noexcept;
    /// A bound of what would still come out if nothing more went in. Audio thread.
    [[nodiscard]] double envelope() const noexcept;

private:
    using Row = std::array<double, sections>;

    /// What a section still rings with once its two states hold these values.
    [[nodiscard]] double ringing(std::size_t section, double first, double second) const noexcept;

    double sampleRateHz_;
    double direct_ = 1.0;
    // A row for each coefficient: so the compiler works on several sections at once.
    Row in0_{};
    Row in1_{};
    Row back1_{};
    Row back2_{};
    Row state1_{};
    Row state2_{};
    // Radius and angle of the poles, as `ringing` needs them.
    Row radius_{};
    Row cosine_{};
    Row sine_{};
};

}  // namespace haptoflow::effects
