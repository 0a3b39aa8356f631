#pragma once

#include "inference/segment_generator.hpp"
#include "learning/prepared_recording.hpp"
#include "model/model_header.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace haptoflow::learning {

using Embedding = std::array<float, inference::embeddingSize>;

/// One run of the network on its own output along a stretch of the recorded motion.
struct Chain {
    /// Index into the embeddings.
    std::size_t embedding = 0;
    /// Sample of the recording where it begins; the 200 before it are its first past.
    std::size_t start = 0;
    /// Chains of equal keys get equal noise.
    std::uint32_t noise = 0;
};

struct LoopSettings {
    std::size_t hopSamples = 100;
    /// Run before the samples that count.
    std::size_t warmSamples = 200;
    std::size_t samples = 512;
    std::uint64_t seed = 0;
    std::uint64_t round = 0;
};

/// Lets the network follow the recording's motion in waves of unit level, many chains in one batch.
class ClosedLoop {
public:
    /// `unitWave`: the recording divided by its level. All of it must outlive the loop.
    ClosedLoop(inference::SegmentGenerator& generator, const model::ModelHeader& model,
               const PreparedRecording& recording, std::span<const float> unitWave);

    /// `settings.samples` of unit level for each chain, one after the other. Each segment is told the mean motion of
    /// its own hop: the recording's ribs are to be met where they are, not where a tracker would see them. Throws
    /// inference::InferenceError.
    [[nodiscard]] std::vector<float> run(std::span<const Embedding> embeddings, std::span<const Chain> chains,
                                         const LoopSettings& settings);

    /// Mean motion of the recording's samples from `first` on, inside the model's range.
    [[nodiscard]] std::array<float, 3> motionFrom(std::size_t first, std::size_t count) const;

    /// One segment for each request. Throws inference::InferenceError.
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments);

    /// Segments made so far.
    [[nodiscard]] std::uint64_t segments() const noexcept { return segments_; }

private:
    inference::SegmentGenerator& generator_;
    const model::ModelHeader& model_;
    const PreparedRecording& recording_;
    std::span<const float> unitWave_;
    std::uint64_t segments_ = 0;
};

}  // namespace haptoflow::learning
