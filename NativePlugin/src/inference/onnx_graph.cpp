#include "inference/onnx_graph.hpp"

#include "model/onnx_check.hpp"

#include <utility>

namespace haptoflow::inference {

OnnxGraph::OnnxGraph(std::shared_ptr<const Runtime> runtime, std::span<const std::byte> graph, std::string name,
                     GraphSignature signature, std::size_t maximumBatch, const LoadLimits& limits)
    : session_(loadChecked(std::move(runtime), graph, std::move(name), std::move(signature), maximumBatch, limits)) {}

std::shared_ptr<GraphSession> OnnxGraph::loadChecked(std::shared_ptr<const Runtime> runtime,
                                                     std::span<const std::byte> graph, std::string name,
                                                     GraphSignature signature, std::size_t maximumBatch,
                                                     const LoadLimits& limits) {
    limits.check();
    model::checkOnnxModel(graph, name);
    return loadGraphSession(std::move(runtime), graph, std::move(name), std::move(signature), maximumBatch, limits);
}

}  // namespace haptoflow::inference
