#pragma once

namespace haptoflow::dsp {

/// Kaiser's shape parameter for a stopband `attenuationDecibels` (above 50 dB) below the passband.
/// J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", 1974.
[[nodiscard]] double kaiserBeta(double attenuationDecibels) noexcept;

/// The window at `position` in [-1, 1] (0 outside), 1 at its centre. Any thread.
[[nodiscard]] double kaiserWindow(double position, double beta) noexcept;

/// sin(pi x) / (pi x).
[[nodiscard]] double normalisedSinc(double x) noexcept;

}  // namespace haptoflow::dsp
