#pragma once

#include <complex>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Kaiser's shape parameter beta for a stopband `attenuationDecibels` (above 50 dB) below the passband.
/// J. F. Kaiser, "Nonrecursive digital filter design using the I0-sinh window function", 1974.
[[nodiscard]] double kaiserBeta(double attenuationDecibels) noexcept;

/// Kaiser window at `position`: 1 at 0, and 0 outside [-1, 1]. Any thread.
[[nodiscard]] double kaiserWindow(double position, double beta) noexcept;

/// sin(pi x) / (pi x).
[[nodiscard]] double normalisedSinc(double x) noexcept;

enum class Direction { forward, inverse };

/// Discrete Fourier transform in place; the inverse divides by the length. Allocates: for filter design and analysis,
/// not for the audio thread. Throws std::invalid_argument unless the length is a power of two.
void fourierTransform(std::vector<std::complex<double>>& values, Direction direction);

/// Writes the impulse response of the minimum-phase filter with this complex cepstrum, of the same length: h[0] =
/// exp(c[0]), and n h[n] is the sum of k c[k] h[n - k] over k from 1 to n (Oppenheim and Schafer, "Discrete-Time Signal
/// Processing", chapter on homomorphic filtering). Folding the cepstrum of log |H| onto positive time gives the one
/// with the same magnitude. Allocates nothing.
void minimumPhaseResponse(std::span<const double> cepstrum, std::span<double> response) noexcept;

}  // namespace haptoflow::dsp
