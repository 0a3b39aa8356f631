#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::effects::testing {

/// Waves of 2 kHz, m/s^2.
[[nodiscard]] std::vector<float> featureSine(double frequencyHz, double amplitudeMps2, double seconds);
/// White noise with this standard deviation.
[[nodiscard]] std::vector<float> featureNoise(double rmsMps2, double seconds, unsigned seed);
/// Noise between about 40 and 400 Hz, as textures have it.
[[nodiscard]] std::vector<float> textureNoise(double rmsMps2, double seconds, unsigned seed);
/// Silence, then from `start` on amplitude e^(-decay t) sin(2 pi f t).
[[nodiscard]] std::vector<float> decayingSinusoidFrom(std::size_t start, double frequencyHz, double amplitudeMps2,
                                                      double decayPerSecond, double seconds);

}  // namespace haptoflow::effects::testing
