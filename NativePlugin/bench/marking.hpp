#pragma once

#include "inference/segment_generator.hpp"
#include "inference/skeleton_generator.hpp"
#include "model/model_file.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace haptoflow::bench {

/// Levels of the two labels of a marking skeleton. From the quiet one to the loud one, the first sample tells the
/// change.
inline constexpr float quietMps2 = 0.001F;
inline constexpr float loudMps2 = 10.0F;

/// A skeleton that sounds as white noise, softly for one label of the model and loudly for another, so that a recording
/// shows when the callback first plays the other label. Throws MeasurementError if the labels have equal embeddings.
[[nodiscard]] skeleton::NativeParts markingParts(const model::ModelFile& model, std::uint32_t quiet,
                                                 std::uint32_t loud);

/// Runs another generator, so that it takes as long, and returns the marking skeleton's segments in place of its own.
class MarkingGenerator final : public inference::SegmentGenerator {
public:
    MarkingGenerator(std::unique_ptr<inference::SegmentGenerator> behind, const skeleton::NativeParts& marking)
        : behind_(std::move(behind)), marking_(marking, 1) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        behind_->generate(requests, segments);
        marking_.generate(requests, segments);
    }
    void generateFromSketches(std::span<const inference::SegmentRequest> requests, std::span<float> segments,
                              const Sketched& sketched) override {
        generate(requests, segments);
        sketched(0, segments);
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        marking_.levels(requests, levelsMps2);
    }

private:
    std::unique_ptr<inference::SegmentGenerator> behind_;
    inference::SkeletonGenerator marking_;
};

}  // namespace haptoflow::bench
