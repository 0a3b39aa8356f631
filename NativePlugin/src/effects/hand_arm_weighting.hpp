#pragma once

#include <array>

namespace haptoflow::effects {

/// The frequency weighting W_h of hand-transmitted vibration, sample by sample.
///
/// ISO 5349-1:2001, annex A (the same in ISO 8041-1), as a product of three transfer functions in s, w = 2 pi f:
///   high-pass      s^2 / (s^2 + w1 s / Q1 + w1^2)                  f1 = 6.310 Hz, Q1 = 1 / sqrt 2
///   low-pass       w2^2 / (s^2 + w2 s / Q1 + w2^2)                 f2 = 1258.9 Hz
///   a-v transition (1 + s / w3) / (1 + s / (Q2 w3) + (s / w3)^2)   f3 = f4 = 15.915 Hz, Q2 = 0.64
/// each discretised by the bilinear transform, prewarped to be exact at its own frequency. The weighting follows
/// acceleration below about 16 Hz and velocity above: 0.958 at 12.5 Hz, 0.101 at 160 Hz, 0.0135 at 1 kHz (table A.2).
///
/// Used by one thread at a time; allocates nothing.
class HandArmWeighting {
public:
    /// `sampleRateHz` is 8 to 192 kHz.
    explicit HandArmWeighting(double sampleRateHz) noexcept;

    /// Filters the next sample.
    [[nodiscard]] double next(double mps2) noexcept;
    void reset() noexcept;

private:
    /// Transposed direct form II.
    struct Section {
        double b0 = 0.0;
        double b1 = 0.0;
        double b2 = 0.0;
        double a1 = 0.0;
        double a2 = 0.0;
        double first = 0.0;
        double second = 0.0;
    };

    std::array<Section, 3> sections_;
};

}  // namespace haptoflow::effects
