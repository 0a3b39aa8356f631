#pragma once

#include "inference/load_limits.hpp"
#include "inference/onnx_graph.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::inference {

/// A tier's level graph, run by ONNX Runtime. Used by one thread at a time; allocates.
class OnnxLevelEstimator final : public LevelEstimator {
public:
    /// Loads, checks and runs the graph. The model need not outlive it. Throws what OnnxGraph's constructor throws.
    OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                       const LoadLimits& limits = {});

    /// Does not run the graph if every request has its own level. Throws InferenceError if the graph fails or returns
    /// an impossible level, std::invalid_argument if the spans differ in size.
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    [[nodiscard]] std::uint64_t runs() const noexcept { return graph_.runs(); }

private:
    void estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2);

    OnnxGraph graph_;
};

}  // namespace haptoflow::inference
