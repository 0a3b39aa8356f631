#pragma once

#include "dsp/sample_rates.hpp"
#include "model/model_header.hpp"
#include "skeleton/excitation.hpp"
#include "skeleton/skeleton_layout.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace haptoflow::inference {

using dsp::segmentSamples;
using dsp::waveformRateHz;
using model::embeddingSize;
using model::SolverKind;
using skeleton::ribCount;
/// Largest magnitude of the natural logarithm of a level in m/s^2. A quieter level cannot be felt, a louder one exceeds
/// every limiter.
inline constexpr double maximumLogLevel = 20.0;
/// Number of levels that one run of a level graph computes, independent of the batch size for segments.
inline constexpr std::size_t levelBatch = 256;

struct SolverSettings {
    SolverKind kind = SolverKind::midpoint;
    int steps = 2;
};

/// What a network needs, with or without a contact state. The caller owns what the spans view while `generate` runs.
struct SegmentRequest {
    std::array<float, embeddingSize> embedding{};
    /// vx, vy in m/s along the surface's tangent axes and force in N, clamped to the trained range.
    std::array<float, 3> motion{};
    /// The 200 committed samples before the segment, m/s^2.
    std::span<const float, segmentSamples> previous;
    /// Standard normal noise, the solver's starting point.
    std::span<const float, segmentSamples> noise;
    /// For the ribs along each wave vector of the embedding and for stick-slip, the turns at the segment's first sample
    /// in [0, 1), then the signed rates in Hz.
    skeleton::Phases phases{};
    /// Factor on the impulses of tiers with a skeleton.
    float impulseGain = 1.0F;
    /// RMS in m/s^2 to use instead of the model's level; if empty, the model's level is used.
    std::optional<float> levelMps2{};
    /// The motion for the model's level where it differs from `motion`, and a gain on the model's level.
    std::optional<std::array<float, 3>> levelMotion{};
    float levelGain = 1.0F;
    /// The starting point of a latent tier's solver, of the latent's size; if empty, it is derived from `noise`.
    std::span<const float> latentNoise{};
    /// The 200 samples before the segment of the skeleton alone, m/s^2; if empty, those that were played.
    std::span<const float> own{};
    /// The skeleton's segment, where a stream has made it already; if null, tiers with a skeleton make it of
    /// `previous`, `noise` and `phases`. In unit scale of the request's level.
    const skeleton::NetworkInput* networkInput = nullptr;
};

/// Estimates a material's level. Used by one thread at a time; may allocate.
class LevelEstimator {
public:
    virtual ~LevelEstimator() = default;

    /// Writes one RMS in m/s^2 for each request: the request's own level, or the model's for its embedding and motion.
    virtual void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) = 0;
};

/// Generates segments. Worker thread; used by one thread at a time; may allocate.
class SegmentGenerator : public LevelEstimator {
public:
    /// Writes requests.size() segments of 200 samples in m/s^2, one after the other, into `segments`
    /// (requests.size() * 200 floats). Throws InferenceError if a graph fails; `segments` is then unspecified.
    virtual void generate(std::span<const SegmentRequest> requests, std::span<float> segments) = 0;
};

}  // namespace haptoflow::inference
