#pragma once

#include "../model/model_builder.hpp"
#include "model/model_file.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

namespace haptoflow::skeleton::testing {

/// How strongly the random weights drive the outputs; 1 is ordinary.
struct ModelStyle {
    std::uint32_t seed = 1;
    float strength = 1.0F;
    std::size_t hidden = 24;
};

/// A model of two labels whose only tier is `sketch`, of kind `skeleton`, with random weights. Tests change it before
/// building.
inline model::testing::ModelBuilder skeletonModel(const ModelStyle& style = {}) {
    model::testing::ModelBuilder builder;
    const auto hidden = static_cast<std::int64_t>(style.hidden);
    builder.header["tiers"] = {{{"name", "sketch"},
                                {"kind", "skeleton"},
                                {"parameters", 12345},
                                {"accuracy", nlohmann::json::object()},
                                {"cost", nlohmann::json::object()}}};
    builder.header["default_tier"] = "sketch";
    builder.header["skeleton"] = {{"order", 24},          {"harmonics", 14},
                                  {"swing_harmonics", 5}, {"rungs", {2.0, 2.6, 3.1, 3.5, 4.0}},
                                  {"hidden", hidden},     {"parameters", 12345}};
    builder.header.erase("seed_bank");
    std::erase_if(builder.blobs, [](const auto& blob) { return blob.name != "embedding"; });
    std::mt19937 random(style.seed);
    std::normal_distribution<float> normal;
    const auto add = [&](const std::string& name, std::vector<std::int64_t> shape, float deviation) {
        std::size_t count = 1;
        for (const std::int64_t dimension : shape) {
            count *= static_cast<std::size_t>(dimension);
        }
        std::vector<float> values(count);
        for (float& value : values) {
            value = deviation * normal(random);
        }
        builder.blobs.push_back({name, "float32", std::move(shape), model::testing::bytesOf(values)});
    };
    const auto addPerceptron = [&](const std::string& name, std::int64_t inputs, std::int64_t outputs) {
        const auto weights = [](std::int64_t columns) { return 1.0F / std::sqrt(static_cast<float>(columns)); };
        add(name + ".0.weight", {hidden, inputs}, weights(inputs));
        add(name + ".0.bias", {hidden}, 0.1F);
        add(name + ".2.weight", {hidden, hidden}, 1.5F * weights(hidden));
        add(name + ".2.bias", {hidden}, 0.1F);
        add(name + ".4.weight", {outputs, hidden}, 2.0F * style.strength * weights(hidden));
        add(name + ".4.bias", {outputs}, 0.3F * style.strength);
    };
    add("level.law.weight", {3, 64}, 0.02F);
    add("level.law.bias", {3}, 0.3F);
    addPerceptron("level.correction", 78, 1);
    addPerceptron("skeleton", 88, 269);
    return builder;
}

/// The same with a second tier, `standard`, of kind `refine`, whose graph no runtime could load.
inline model::testing::ModelBuilder refinedModel(const ModelStyle& style = {}) {
    model::testing::ModelBuilder builder = skeletonModel(style);
    builder.blobs.push_back({"standard.field", "onnx", {}, model::testing::Bytes(50, std::byte{0x11})});
    builder.header["tiers"].push_back({{"name", "standard"},
                                       {"kind", "refine"},
                                       {"field", "standard.field"},
                                       {"parameters", 777},
                                       {"accuracy", nlohmann::json::object()},
                                       {"cost", nlohmann::json::object()}});
    return builder;
}

inline model::ModelFile read(const model::testing::ModelBuilder& builder) {
    return model::ModelFile::parse(builder.build());
}

}  // namespace haptoflow::skeleton::testing
