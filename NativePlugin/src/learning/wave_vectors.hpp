#pragma once

#include "inference/segment_generator.hpp"
#include "learning/sliding.hpp"
#include "recordings/prepared_recording.hpp"

#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {

/// The wave vector of a family of ribs or threads, perpendicular to them, in cycles per millimetre.
struct WaveVector {
    double x = 0.0;
    double y = 0.0;
};

/// Finds at most two vectors, the most distinct first, with wavelengths of 0.4 to 8 mm: spectral lines whose frequency
/// follows the speed, by direction. Empty if there are none, or if the recording cannot show them: less than about 0.2
/// m of path, or a constant speed. If all strokes have one direction, a vector is parallel to it.
///
/// A ruled surface with wave vector k sounds at |k . v|: as a function of the position x on the surface, it is a line
/// at exp(2 pi i k . x), independent of speed and direction. The evidence for a line at k is the mean of the windows'
/// spectra there divided by that of its neighbours; the evidence for ribs combines their first six harmonics.
[[nodiscard]] std::vector<WaveVector> findWaveVectors(const recordings::PreparedRecording& recording,
                                                      const Sliding& sliding);

/// The same for a wave at 2 kHz, in which a sample that is not finite separates recordings, with vx and vy in m/s for
/// each sample. Training calls it through the C interface.
[[nodiscard]] std::vector<WaveVector> findWaveVectors(std::span<const float> wave,
                                                      std::span<const float> velocitiesMps);

/// Rotation of a material's frame relative to its recording. A surface may be recorded at any angle, but a ruled
/// material's first axis is perpendicular to its most distinct ribs, as in the labels that the networks were trained
/// on. Without ribs the frame is that of the recording.
struct MaterialFrame {
    /// Angle from the recording's first axis to the material's.
    double turnRadians = 0.0;
    /// k1x, k1y, k2x, k2y in cycles per millimetre in the material's frame, 0 for none.
    std::array<float, 2 * inference::ribCount> waveNumbers{};

    /// Up to two vectors in the recording's frame, the most distinct first; zero vectors are skipped.
    [[nodiscard]] static MaterialFrame across(std::span<const WaveVector> vectors);

    /// Rotates the recording's motion into the material's frame.
    void turn(recordings::PreparedRecording& recording) const;
};

}  // namespace haptoflow::learning
