#pragma once

#include "inference/segment_generator.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

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

}  // namespace haptoflow::bench
