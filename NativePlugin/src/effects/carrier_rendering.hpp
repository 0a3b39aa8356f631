#pragma once

#include "effects/wave_features.hpp"

#include <span>
#include <vector>

namespace haptoflow::effects {

/// How a device moves from one frame's amplitude and frequency to the next.
enum class CarrierShape {
    /// Holds both for the frame and moves within its first half millisecond: impulses, amplitude envelopes.
    held,
    /// Moves in straight lines between the middles of the frames: parametric points.
    linear
};

struct CarrierRendering {
    CarrierShape shape = CarrierShape::held;
    double sampleRateHz = WaveFeatures::sampleRateHz;
    /// Time constant with which the motor itself follows a change of amplitude; 0 for at once.
    double riseSeconds = 0.0;
};

/// The wave that a device's motor would play for consecutive frames, m/s^2 at `sampleRateHz`, from the first frame's
/// start to the last one's end; its phase never jumps. Transients are not added: the amplitude holds their energy.
/// For previews and tests: allocates. A rate that is not above 0 gives nothing.
[[nodiscard]] std::vector<float> renderCarrier(std::span<const WaveFrame> frames,
                                               const CarrierRendering& rendering = {});

/// How one frame of a rendering differs from the wave that was wanted.
struct IntensityError {
    double startSeconds = 0.0;
    double wantedIntensity = 0.0;
    double playedIntensity = 0.0;
    /// 20 log10 (played / wanted), each at least 1, the detection threshold: what is not felt does not count.
    double errorDb = 0.0;
};

/// Over the frames of which at least one of the two is felt.
struct IntensityErrorSummary {
    std::size_t feltFrames = 0;
    double meanDb = 0.0;
    double meanMagnitudeDb = 0.0;
    /// Of the magnitudes, 95 of 100 are below.
    double percentile95Db = 0.0;
};

/// Compares the perceived intensity of a wave and of its rendering, both 2 kHz and starting together, frame by frame.
/// Frames are cut as `options` says; its device range and onsets play no role. Frames that are felt in neither wave are
/// left out. Allocates.
[[nodiscard]] std::vector<IntensityError> intensityErrors(std::span<const float> wantedMps2,
                                                          std::span<const float> playedMps2,
                                                          const WaveFeatureOptions& options = {});
[[nodiscard]] IntensityErrorSummary summarise(std::span<const IntensityError> errors);

/// All frames of a whole wave of 2 kHz, as `WaveFeatures` finds them; the last one may reach beyond its end. Allocates.
[[nodiscard]] std::vector<WaveFrame> framesOf(std::span<const float> waveMps2, const WaveFeatureOptions& options = {});

}  // namespace haptoflow::effects
