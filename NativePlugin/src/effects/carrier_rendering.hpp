#pragma once

#include "effects/wave_features.hpp"

#include <span>
#include <vector>

namespace haptoflow::effects {

/// How a device changes from one frame's amplitude and frequency to the next.
enum class CarrierShape {
    /// Holds both over the frame and changes within its first half millisecond, like impulses and amplitude envelopes.
    held,
    /// Interpolates linearly between the middles of the frames, like parametric points.
    linear
};

/// The 2 kHz wave that a device's motor would play for consecutive frames, in m/s^2, from the start of the first frame
/// to the end of the last; its phase is continuous. Transients are not added, because the amplitude already contains
/// their energy. For previews: allocates.
[[nodiscard]] std::vector<float> renderCarrier(std::span<const WaveFrame> frames, CarrierShape shape);

/// Differences in intensity between the frames of a rendering and the original wave, in dB: 20 log10 (played / wanted),
/// with each intensity raised to at least 1, the detection threshold. Over the frames in which at least one of the two
/// waves is felt.
struct IntensityErrors {
    std::size_t feltFrames = 0;
    double meanDb = 0.0;
    double meanMagnitudeDb = 0.0;
    /// 95th percentile of the magnitudes.
    double percentile95Db = 0.0;
};

/// Compares the perceived intensity of a wave and of its rendering frame by frame. Both waves have 2 kHz and start at
/// the same time. `options` sets the frame length; its device range has no effect. Allocates.
[[nodiscard]] IntensityErrors intensityErrors(std::span<const float> wantedMps2, std::span<const float> playedMps2,
                                              const WaveFeatureOptions& options = {});

/// All frames of a whole 2 kHz wave, computed by `WaveFeatures`. The last frame may extend beyond the end. Allocates.
[[nodiscard]] std::vector<WaveFrame> framesOf(std::span<const float> waveMps2, const WaveFeatureOptions& options = {});

}  // namespace haptoflow::effects
