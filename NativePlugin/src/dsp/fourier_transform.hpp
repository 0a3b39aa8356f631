#pragma once

#include <complex>
#include <vector>

namespace haptoflow::dsp {

enum class Direction { forward, inverse };

/// Discrete Fourier transform in place; the inverse divides by the length. Allocates: for filter design and analysis,
/// not for the audio thread. Throws std::invalid_argument unless the length is a power of two.
void fourierTransform(std::vector<std::complex<double>>& values, Direction direction);

}  // namespace haptoflow::dsp
