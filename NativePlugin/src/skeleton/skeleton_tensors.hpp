#pragma once

#include "model/model_file.hpp"
#include "skeleton/perceptron.hpp"
#include "skeleton/skeleton.hpp"

#include <memory>
#include <string_view>

namespace haptoflow::skeleton {

/// Read the tensors of a model and check their shapes. Each throws model::ModelError (inconsistent) that names the blob
/// and the remedy. For loading; they allocate.
[[nodiscard]] std::shared_ptr<const LevelModel> readLevelModel(const model::ModelFile& model);
[[nodiscard]] std::shared_ptr<const Skeleton> readSkeleton(const model::ModelFile& model);
/// What all tiers of the kinds `skeleton` and `refine` of a model have in common. Any number of generators and threads
/// use one copy, so that the weights which one has just used are in the processor's caches for the next.
struct NativeParts {
    std::shared_ptr<const LevelModel> level;
    std::shared_ptr<const Skeleton> skeleton;
};
/// Both null for a model without a skeleton.
[[nodiscard]] NativeParts readNativeParts(const model::ModelFile& model);
/// The parts that others of the model already use, or else those of the file.
[[nodiscard]] NativeParts sharedOrRead(const NativeParts& shared, const model::ModelFile& model);

/// The perceptron `<tier>.condition` of a tier of kind `refine`.
[[nodiscard]] Perceptron readConditioning(const model::ModelFile& model, std::string_view tier);

}  // namespace haptoflow::skeleton
