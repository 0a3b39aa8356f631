#pragma once

#include "inference/graph_session.hpp"
#include "inference/tier_generator.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haptoflow::inference {

/// The levels of a model with a skeleton, computed natively. Any thread; no allocation.
class SkeletonLevelEstimator final : public LevelEstimator {
public:
    explicit SkeletonLevelEstimator(std::shared_ptr<const skeleton::LevelModel> level);

    /// Throws InferenceError for an impossible level, std::invalid_argument if the spans differ in size.
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

private:
    std::shared_ptr<const skeleton::LevelModel> level_;
};

/// A tier of kind `skeleton`: needs no ONNX Runtime. Used by one thread at a time.
class SkeletonGenerator final : public TierGenerator {
public:
    /// Throws what makeGenerator throws.
    SkeletonGenerator(skeleton::NativeParts native, std::size_t maximumBatch, const LoadLimits& limits = {});

    /// Allocates for the largest number of requests so far.
    void generate(std::span<const SegmentRequest> requests, std::span<float> segments) override;
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

private:
    SkeletonLevelEstimator level_;
    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    std::vector<float> levelsMps2_;
};

/// A tier of kind `refine`: the skeleton, and a graph that corrects it. Conditioning is native, so that a batch is one
/// run of a small graph. Used by one thread at a time; allocates.
class RefinedGenerator final : public TierGenerator {
public:
    /// Throws what makeGenerator throws.
    RefinedGenerator(const GraphSource& source, skeleton::NativeParts native);

    void generate(std::span<const SegmentRequest> requests, std::span<float> segments) override;
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    /// Number of runs of the graph; tests use it to show that nothing is computed needlessly.
    [[nodiscard]] std::uint64_t graphRuns() const noexcept { return graph_->runs(); }

private:
    void generateBatch(std::span<const SegmentRequest> requests, std::span<float> segments);

    std::size_t maximumBatch_;
    SkeletonLevelEstimator level_;
    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    skeleton::Perceptron conditioning_;
    std::shared_ptr<GraphSession> graph_;
    std::vector<float> levelsMps2_;
};

}  // namespace haptoflow::inference
