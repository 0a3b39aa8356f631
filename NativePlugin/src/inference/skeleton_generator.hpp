#pragma once

#include "inference/graph_session.hpp"
#include "inference/tier_generator.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstddef>
#include <memory>
#include <span>

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

/// A tier of kind `skeleton`: needs no ONNX Runtime.
class SkeletonGenerator final : public TierGenerator {
public:
    /// Throws what makeGenerator throws.
    SkeletonGenerator(skeleton::NativeParts native, std::size_t maximumBatch, const LoadLimits& limits = {});

private:
    void generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                       std::span<float> segments) override;

    std::shared_ptr<const skeleton::Skeleton> skeleton_;
};

/// A tier of kind `refine`: the skeleton, and a graph that corrects it. Conditioning is native, so that a batch is one
/// run of a small graph.
class RefinedGenerator final : public TierGenerator {
public:
    /// Throws what makeGenerator throws.
    RefinedGenerator(const GraphSource& source, skeleton::NativeParts native);

private:
    void generateBatch(std::span<const SegmentRequest> requests, std::span<const float> levelsMps2,
                       std::span<float> segments) override;

    std::shared_ptr<const skeleton::Skeleton> skeleton_;
    skeleton::Perceptron conditioning_;
    std::shared_ptr<GraphSession> graph_;
};

}  // namespace haptoflow::inference
