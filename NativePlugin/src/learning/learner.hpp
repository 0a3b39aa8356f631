#pragma once

#include "inference/load_limits.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/segment_generator.hpp"
#include "learning/learning_report.hpp"
#include "model/model_file.hpp"
#include "recordings/recording.hpp"

#include <memory>
#include <span>
#include <string>

namespace haptoflow::learning {

struct LearntMaterial {
    /// Text of the material file.
    std::string materialJson;
    LearningReport report;
};

/// Another tier of the model, with which the learnt material is compared with the recording.
struct OtherTier {
    std::string name;
    std::unique_ptr<inference::SegmentGenerator> generator;
};

/// Learns a material from a recording: level law, wave vectors, embedding and tone. `generator` is one of the model's
/// tiers. Equal arguments give equal bytes. Throws recordings::RecordingUnusable, std::invalid_argument,
/// inference::LoadCancelled and inference::InferenceError. For worker threads.
[[nodiscard]] LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                                           inference::SegmentGenerator& generator, const LearningSettings& settings,
                                           std::span<const OtherTier> otherTiers = {});

/// The same on one of the model's tiers, of which it opens all; compares the material on the others. Without a runtime,
/// only tiers that need none are opened.
[[nodiscard]] LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                                           const model::Tier& tier, std::shared_ptr<const inference::Runtime> runtime,
                                           const LearningSettings& settings, const inference::LoadLimits& limits = {});

}  // namespace haptoflow::learning
