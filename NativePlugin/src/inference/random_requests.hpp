#pragma once

#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace haptoflow::inference {

/// Requests for which one segment is timed, natively and in browsers: the same number in both, so that they are the
/// same.
inline constexpr std::size_t requestCount = 64;

/// Random requests as live voices make them. Labels and motions lie within the recorded range; the previous waveform
/// and the noise are standard normal.
class RandomRequests {
public:
    RandomRequests(const model::ModelFile& model, std::size_t count, std::uint64_t seed)
        : waves_(2 * count * segmentSamples) {
        skeleton::fillStandardNormal({.seed = seed, .voice = 0, .segment = 0}, waves_);
        std::mt19937_64 generator(seed);
        std::uniform_real_distribution<double> share(0.05, 0.95);
        std::uniform_int_distribution<std::size_t> label(0, model.header().labels.size() - 1);
        requests_.reserve(count);
        for (std::size_t index = 0; index < count; ++index) {
            using Wave = std::span<const float, segmentSamples>;
            const float* waves = waves_.data() + 2 * index * segmentSamples;
            SegmentRequest request{.embedding = {},
                                   .motion = {static_cast<float>(model.header().speedMps.at(share(generator))), 0.0F,
                                              static_cast<float>(model.header().forceNewtons.at(share(generator)))},
                                   .previous = Wave(waves, segmentSamples),
                                   .noise = Wave(waves + segmentSamples, segmentSamples)};
            const auto embedding = model.embedding(label(generator));
            std::copy(embedding.begin(), embedding.end(), request.embedding.begin());
            request.phases = skeleton::phasesOf(request.embedding, request.motion, {});
            requests_.push_back(request);
        }
    }

    /// The next `count` requests, starting again after the last one; `count` is at most their number.
    [[nodiscard]] std::span<const SegmentRequest> next(std::size_t count) {
        if (at_ + count > requests_.size()) {
            at_ = 0;
        }
        const auto chosen = std::span(requests_).subspan(at_, count);
        at_ += count;
        return chosen;
    }

private:
    std::vector<float> waves_;
    std::vector<SegmentRequest> requests_;
    std::size_t at_ = 0;
};

}  // namespace haptoflow::inference
