#pragma once

#include "bench/bench_plan.hpp"
#include "engine/live_engine.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/tier_generator.hpp"
#include "model/model_file.hpp"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <vector>

namespace haptoflow::bench {

/// Voices in one batch: the default of the C interface.
inline constexpr std::size_t defaultBatch = 8;

/// A measurement failed because there was no sound or no segment to measure.
class MeasurementError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The open library, models and settings that the measurements use. Any thread may read them.
struct Subjects {
    std::shared_ptr<const inference::Runtime> runtime;
    std::shared_ptr<const model::ModelFile> model;
    /// The model of the paper's architecture; null if no file was given.
    std::shared_ptr<const model::ModelFile> paper;
    /// Seed of all noise and of every random order.
    std::uint64_t seed = 1;

    /// The tier "standard", or the model's default tier if it has no such tier.
    [[nodiscard]] const model::Tier& standard() const;
    /// A tier of `file` with its own solver.
    [[nodiscard]] std::unique_ptr<inference::TierGenerator> generator(const model::ModelFile& file,
                                                                      const model::Tier& tier, std::size_t batch) const;
    /// An engine with a single fixed tier, and with another skeleton than the model's if one is given.
    [[nodiscard]] std::unique_ptr<engine::LiveEngine> engineWith(std::unique_ptr<inference::SegmentGenerator> generator,
                                                                 bool hasWorker,
                                                                 const skeleton::NativeParts& native = {}) const;
    /// An engine with the tier "standard" for `defaultBatch` voices.
    [[nodiscard]] std::unique_ptr<engine::LiveEngine> standardEngine(bool hasWorker) const;
};

/// The contact states of a tip that slides over a model's labels in the middle of its recorded range.
class Hand {
public:
    /// The hand uses the model's first labels, at most this many. Without a skeleton a touch begins with a seed, so
    /// that labels without one are left out.
    static constexpr std::size_t maximumLabels = 16;

    explicit Hand(const model::ModelFile& model);

    [[nodiscard]] std::size_t labelCount() const noexcept { return labels_.size(); }
    /// Index in the model's labels of the label at a place in the hand's list.
    [[nodiscard]] std::uint32_t label(std::size_t place) const { return labels_.at(place); }
    /// A state of sliding; `speedShare` and the fixed force are shares of the recorded range.
    [[nodiscard]] engine::ContactState sliding(std::uint32_t touch, std::size_t place, double speedShare = 0.3) const;
    [[nodiscard]] static engine::ContactState lifted(std::uint32_t touch);

private:
    std::vector<std::uint32_t> labels_;
    model::TrainedInterval speedMps_;
    model::TrainedInterval forceNewtons_;
};

struct SubjectFiles {
    std::filesystem::path runtimeLibrary;
    std::filesystem::path model;
    /// A model of the paper's architecture; empty for none.
    std::filesystem::path paperModel;
};

/// Opens the library, the models and the engine, and adds the cost of that to `report`: "memory_mib" and its parts,
/// "load_ms" and its parts. Memory can only be measured at the first opening in a process, so that this must run before
/// everything else.
/// Throws model::ModelError, inference::RuntimeUnavailable, inference::InferenceError.
[[nodiscard]] Subjects openSubjects(const SubjectFiles& files, std::uint64_t seed, nlohmann::ordered_json& report);

/// Opens the model and creates its engine repeatedly, compared with plain reading of the same file; completes "load".
void measureLoads(const SubjectFiles& files, const Subjects& subjects, const BenchPlan& plan, const Advance& advance,
                  nlohmann::ordered_json& report);

}  // namespace haptoflow::bench
