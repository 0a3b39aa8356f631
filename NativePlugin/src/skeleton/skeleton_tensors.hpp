#pragma once

#include "model/model_file.hpp"
#include "skeleton/level_model.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton.hpp"

#include <memory>
#include <string_view>

namespace haptoflow::skeleton {

/// Read the tensors of a model and check their shapes. Each throws model::ModelError (inconsistent) that names the blob
/// and the remedy. For loading; they allocate.
[[nodiscard]] std::shared_ptr<const LevelModel> readLevelModel(const model::ModelFile& model);
[[nodiscard]] std::shared_ptr<const Skeleton> readSkeleton(const model::ModelFile& model);
/// The perceptron `<tier>.condition` of a tier of kind `refine`.
[[nodiscard]] Perceptron readConditioning(const model::ModelFile& model, std::string_view tier);

}  // namespace haptoflow::skeleton
