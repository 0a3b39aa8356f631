#include "label_textures.hpp"

#include "inference/gaussian_noise.hpp"
#include "inference/skeleton_generator.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

namespace haptoflow::cli {
namespace {

constexpr std::size_t segment = inference::segmentSamples;
/// Segments made before the excerpt and thrown away, because the filter begins in silence.
constexpr std::size_t settlingSegments = 4;

/// A sketch that slides over a label at one motion.
TextureExcerpt sketched(inference::SkeletonGenerator& sketch, std::span<const float, model::embeddingSize> embedding,
                        const std::array<float, 3>& motion, std::uint32_t voice) {
    std::array<float, segment> previous{};
    std::array<float, segment> noise{};
    inference::SegmentRequest request{
        .embedding = {}, .motion = motion, .previous = previous, .noise = noise, .levelMps2 = 1.0F};
    std::ranges::copy(embedding, request.embedding.begin());
    request.phases = skeleton::phasesOf(embedding, motion, {});
    TextureExcerpt excerpt{};
    static_assert(excerpt.size() == 2 * segment);
    for (std::size_t index = 0; index < settlingSegments + 2; ++index) {
        inference::fillStandardNormal({.seed = 1, .voice = voice, .segment = index}, noise);
        std::shift_left(excerpt.begin(), excerpt.end(), segment);
        sketch.generate(std::span(&request, 1), std::span(excerpt).last<segment>());
        std::ranges::copy(std::span(excerpt).last<segment>(), previous.begin());
        request.phases = skeleton::advanced(request.phases, static_cast<double>(segment));
    }
    return excerpt;
}

}  // namespace

LabelTextures::LabelTextures(const model::ModelFile& model)
    : model_(model), native_(skeleton::readNativeParts(model)) {}

std::vector<TextureExcerpt> LabelTextures::of(std::size_t label) const {
    const model::ModelHeader& header = model_.header();
    std::vector<TextureExcerpt> excerpts;
    for (std::size_t seed = 0; seed < header.seeds.size(); ++seed) {
        if (header.seeds[seed].label == label) {
            std::ranges::copy(model_.seed(seed), excerpts.emplace_back().begin());
        }
    }
    if (header.skeleton) {
        inference::SkeletonGenerator sketch(native_, 1);
        for (const double speed : header.speedMps.percentiles) {
            for (const double force : header.forceNewtons.percentiles) {
                excerpts.push_back(sketched(sketch, model_.embedding(label),
                                            {static_cast<float>(speed), 0.0F, static_cast<float>(force)},
                                            static_cast<std::uint32_t>(excerpts.size())));
            }
        }
    }
    return excerpts;
}

}  // namespace haptoflow::cli
