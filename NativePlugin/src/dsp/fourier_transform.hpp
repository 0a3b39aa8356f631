#pragma once

#include <complex>
#include <vector>

namespace haptoflow::dsp {

enum class Direction { forward, inverse };

/// The discrete Fourier transform in place; the inverse is divided by the length. For design and analysis: allocates.
/// Throws std::invalid_argument unless the length is a power of two.
void fourierTransform(std::vector<std::complex<double>>& values, Direction direction);

}  // namespace haptoflow::dsp
