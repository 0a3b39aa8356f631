#pragma once

#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace haptoflow::bench {

/// Counts the runs and requests of another generator.
class CountingGenerator final : public inference::SegmentGenerator {
public:
    explicit CountingGenerator(std::unique_ptr<inference::SegmentGenerator> behind) : behind_(std::move(behind)) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        runs.fetch_add(1, std::memory_order_relaxed);
        behind_->generate(requests, segments);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        runs.fetch_add(1, std::memory_order_relaxed);
        behind_->levels(requests, levelsMps2);
    }

    /// Any thread may read these.
    std::atomic<std::uint64_t> runs{0};

private:
    std::unique_ptr<inference::SegmentGenerator> behind_;
};

/// Takes as long as another generator, then replaces each segment by a constant that identifies its label, so that a
/// recording shows when the first sample of a new label plays.
class MarkingGenerator final : public inference::SegmentGenerator {
public:
    /// `labels`: the model's labels that are distinguished, each by its place in this list. The model must outlive the
    /// generator.
    MarkingGenerator(std::unique_ptr<inference::SegmentGenerator> behind, const model::ModelFile& model,
                     std::vector<std::uint32_t> labels)
        : behind_(std::move(behind)), model_(model), labels_(std::move(labels)) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override;
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        behind_->levels(requests, levelsMps2);
    }

    /// The constant in m/s^2, one step higher for each place. Sixteen of them stay below the limiter's knee.
    [[nodiscard]] static float markMps2(std::size_t place) noexcept { return 2.0F * static_cast<float>(place + 1); }

private:
    std::unique_ptr<inference::SegmentGenerator> behind_;
    const model::ModelFile& model_;
    std::vector<std::uint32_t> labels_;
};

}  // namespace haptoflow::bench
