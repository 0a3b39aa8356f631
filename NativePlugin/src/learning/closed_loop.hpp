#pragma once

#include "inference/segment_generator.hpp"
#include "model/model_header.hpp"
#include "recordings/prepared_recording.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace haptoflow::learning {

using Embedding = std::array<float, inference::embeddingSize>;

/// One run of the network, with its own output as previous waveform, along a stretch of the recorded motion.
struct Chain {
    /// Index in the embeddings.
    std::size_t embedding = 0;
    /// Sample of the recording at which it starts; the 200 samples before it are the first previous waveform.
    std::size_t start = 0;
    /// Chains with equal keys have equal noise.
    std::uint32_t noise = 0;
    /// Instead of the recorded motion: vx, vy in m/s and force in N, the same throughout.
    std::optional<std::array<float, 3>> steadyMotion{};
};

struct LoopSettings {
    std::size_t hopSamples = 100;
    /// Generated before the samples that are used.
    std::size_t warmSamples = 200;
    std::size_t samples = 512;
    std::uint64_t seed = 0;
    std::uint64_t round = 0;
};

/// Runs the network in closed loop along the recording's motion, with waves of unit level and many chains in a batch.
class ClosedLoop {
public:
    /// `unitWave`: the recording divided by its level. All arguments must outlive the loop.
    ClosedLoop(inference::SegmentGenerator& generator, const model::ModelHeader& model,
               const recordings::PreparedRecording& recording, std::span<const float> unitWave);

    /// Returns `settings.samples` samples of unit level for each chain, one chain after the other. The motion of each
    /// segment is the mean over its own hop, without the delay of a tracker, so that generated ribs coincide with the
    /// recorded ones. Throws inference::InferenceError.
    [[nodiscard]] std::vector<float> run(std::span<const Embedding> embeddings, std::span<const Chain> chains,
                                         const LoopSettings& settings);

    /// Number of segments generated so far.
    [[nodiscard]] std::uint64_t segments() const noexcept { return segments_; }

private:
    /// Mean motion of the chain's samples from `first` on, limited to the model's range.
    [[nodiscard]] std::array<float, 3> motionFrom(const Chain& chain, std::size_t first, std::size_t count) const;
    [[nodiscard]] std::array<float, 3> limited(const std::array<double, 3>& motion) const;

    inference::SegmentGenerator& generator_;
    const model::ModelHeader& model_;
    const recordings::PreparedRecording& recording_;
    std::span<const float> unitWave_;
    std::uint64_t segments_ = 0;
};

}  // namespace haptoflow::learning
