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

struct CarrierRendering {
    CarrierShape shape = CarrierShape::held;
    double sampleRateHz = WaveFeatures::sampleRateHz;
    /// Time constant of the motor's response to a change of amplitude; 0 for an immediate response.
    double riseSeconds = 0.0;
};

/// The wave that a device's motor would play for consecutive frames, in m/s^2 at `sampleRateHz`, from the start of the
/// first frame to the end of the last; its phase is continuous. Transients are not added, because the amplitude already
/// contains their energy. Empty for a rate that is not above 0. For previews and tests: allocates.
[[nodiscard]] std::vector<float> renderCarrier(std::span<const WaveFrame> frames,
                                               const CarrierRendering& rendering = {});

/// Difference in intensity between one frame of a rendering and the original wave.
struct IntensityError {
    double startSeconds = 0.0;
    double wantedIntensity = 0.0;
    double playedIntensity = 0.0;
    /// 20 log10 (played / wanted), with each intensity raised to at least 1, the detection threshold.
    double errorDb = 0.0;
};

/// Statistics over the frames in which at least one of the two waves is felt.
struct IntensityErrorSummary {
    std::size_t feltFrames = 0;
    double meanDb = 0.0;
    double meanMagnitudeDb = 0.0;
    /// 95th percentile of the magnitudes.
    double percentile95Db = 0.0;
};

/// Compares the perceived intensity of a wave and of its rendering frame by frame. Both waves have 2 kHz and start at
/// the same time. `options` sets the frame length; its device range and onset settings have no effect. Skips frames in
/// which neither wave is felt. Allocates.
[[nodiscard]] std::vector<IntensityError> intensityErrors(std::span<const float> wantedMps2,
                                                          std::span<const float> playedMps2,
                                                          const WaveFeatureOptions& options = {});
[[nodiscard]] IntensityErrorSummary summarise(std::span<const IntensityError> errors);

/// All frames of a whole 2 kHz wave, computed by `WaveFeatures`. The last frame may extend beyond the end. Allocates.
[[nodiscard]] std::vector<WaveFrame> framesOf(std::span<const float> waveMps2, const WaveFeatureOptions& options = {});

}  // namespace haptoflow::effects
