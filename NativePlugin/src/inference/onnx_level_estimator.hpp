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

/// Levels that one run of the level graph gives, whatever the batch of the segments: tables ask for thousands.
inline constexpr std::size_t levelBatch = 256;

/// A tier's level graph behind ONNX Runtime. One user at a time; allocates.
class OnnxLevelEstimator final : public LevelEstimator {
public:
    /// Loads, checks and runs the graph; the model may go afterwards. Throws what OnnxGraph's constructor throws.
    OnnxLevelEstimator(std::shared_ptr<const Runtime> runtime, const model::ModelFile& model, const model::Tier& tier,
                       const LoadLimits& limits = {});

    /// Runs nothing where every request has a level of its own. Throws InferenceError where the graph fails or returns
    /// what no level can be, std::invalid_argument for a span of another size.
    void levels(std::span<const SegmentRequest> requests, std::span<float> levelsMps2) override;

    [[nodiscard]] std::uint64_t runs() const noexcept { return graph_.runs(); }

private:
    void estimate(std::span<const SegmentRequest> requests, std::span<float> levelsMps2);

    OnnxGraph graph_;
};

}  // namespace haptoflow::inference
