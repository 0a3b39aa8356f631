#pragma once

#include "../model/onnx_writer.hpp"
#include "model/model_file.hpp"

#include <functional>
#include <map>
#include <string>

namespace haptoflow::inference::testing {

/// A builder that holds the model's header and blobs.
inline model::testing::ModelBuilder builderOf(const model::ModelFile& model) {
    model::testing::ModelBuilder builder;
    builder.header = nlohmann::json::parse(model.headerText());
    builder.header.erase("blobs");
    builder.blobs.clear();
    for (const model::Blob& blob : model.header().blobs) {
        const auto bytes = model.blob(blob.name);
        builder.blobs.push_back({blob.name, blob.type == model::BlobType::onnx ? "onnx" : "float32", blob.shape,
                                 model::testing::Bytes(bytes.begin(), bytes.end())});
    }
    return builder;
}

/// The bytes of a model file with some graphs replaced and the header edited.
inline model::testing::Bytes withGraphs(
    const model::ModelFile& model, const std::map<std::string, model::testing::Bytes>& graphs,
    const std::function<void(nlohmann::json&)>& editHeader = [](nlohmann::json&) {}) {
    model::testing::ModelBuilder builder = builderOf(model);
    for (const auto& [name, graph] : graphs) {
        blobOf(builder, name).bytes = graph;
    }
    editHeader(builder.header);
    return builder.build();
}

}  // namespace haptoflow::inference::testing
