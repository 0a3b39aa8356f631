#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace haptoflow::inference {

inline constexpr std::size_t segmentSamples = 200;
inline constexpr std::size_t embeddingSize = 64;
inline constexpr double waveformRateHz = 2000.0;
/// How many wave vectors an embedding has. Their x and y components, in cycles per millimetre, are the embedding's last
/// 2 * ribCount numbers; they are zero for a material without ribs.
inline constexpr std::size_t ribCount = 2;

enum class SolverKind { euler, midpoint, heun };

struct SolverSettings {
    SolverKind kind = SolverKind::midpoint;
    int steps = 2;
};

/// What one segment is generated from. Pointers stay the caller's and are read during `generate` only.
struct SegmentRequest {
    std::array<float, embeddingSize> embedding{};
    /// vx, vy in m/s in the surface's tangent axes, force in N; already inside the trained range.
    std::array<float, 3> motion{};
    /// The 200 committed samples before the segment, m/s^2.
    std::span<const float, segmentSamples> previous;
    /// Standard normal noise, the solver's starting point.
    std::span<const float, segmentSamples> noise;
    /// For each of the embedding's wave vectors, how far the tip has travelled along it at the segment's first sample:
    /// turns in [0, 1). Read by graphs that have the input `rib_phase`.
    std::array<float, ribCount> ribPhase{};
    /// RMS in m/s^2 to be used instead of what the level graph says; empty for the graph's.
    std::optional<float> levelMps2{};
    /// What the level graph is asked for where that is not `motion`, and the gain on its answer.
    std::optional<std::array<float, 3>> levelMotion{};
    float levelGain = 1.0F;
};

/// Says how loud a material is. One user at a time; may allocate.
class LevelEstimator {
public:
    LevelEstimator() = default;
    LevelEstimator(const LevelEstimator&) = delete;
    LevelEstimator& operator=(const LevelEstimator&) = delete;
    virtual ~LevelEstimator() = default;

    /// RMS in m/s^2 that the model expects for each (embedding, motion) of `requests`, or the request's own level;
    /// writes one float each.
    virtual void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) = 0;
};

/// Turns contact states into segments. Worker thread; one user at a time; may allocate.
class SegmentGenerator : public LevelEstimator {
public:
    /// Writes requests.size() segments of 200 samples in m/s^2, one after the other, into `segments`
    /// (requests.size() * 200 floats). Throws InferenceError when a graph fails; `segments` is then unspecified.
    virtual void generate(std::span<const SegmentRequest> requests, std::span<float> segments) = 0;
};

}  // namespace haptoflow::inference
