#pragma once

#include "inference/onnx_runtime.hpp"
#include "inference/tier_generator.hpp"
#include "model/model_file.hpp"

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

namespace haptoflow::testing {

/// A tier of a model with its own solver, as the engine loads it; the default tier if none is named. Throws
/// std::invalid_argument for an unknown tier.
inline std::unique_ptr<inference::TierGenerator> generatorOf(const model::ModelFile& model, std::size_t maximumBatch,
                                                             const std::string& name = {}) {
    const model::ModelHeader& header = model.header();
    const model::Tier* tier = name.empty() ? &header.tiers[header.defaultTier] : model.findTier(name);
    if (tier == nullptr) {
        throw std::invalid_argument("no tier " + name);
    }
    return inference::makeGenerator(inference::Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME), model, *tier,
                                    inference::defaultSolver(*tier), maximumBatch);
}

}  // namespace haptoflow::testing
