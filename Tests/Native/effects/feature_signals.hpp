#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::effects::testing {

/// 2 kHz waves in m/s^2.
[[nodiscard]] std::vector<float> featureSine(double frequencyHz, double amplitudeMps2, double seconds);
/// White noise with the RMS `rmsMps2`.
[[nodiscard]] std::vector<float> featureNoise(double rmsMps2, double seconds, unsigned seed);
/// Noise between about 40 and 400 Hz, like a texture.
[[nodiscard]] std::vector<float> textureNoise(double rmsMps2, double seconds, unsigned seed);
/// Silence until `start`, then amplitude e^(-decay t) sin(2 pi f t).
[[nodiscard]] std::vector<float> decayingSinusoidFrom(std::size_t start, double frequencyHz, double amplitudeMps2,
                                                      double decayPerSecond, double seconds);

}  // namespace haptoflow::effects::testing
