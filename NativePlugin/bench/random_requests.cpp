#include "bench/random_requests.hpp"

#include "inference/gaussian_noise.hpp"
#include "skeleton/condition.hpp"

#include <algorithm>
#include <random>

namespace haptoflow::bench {

RandomRequests::RandomRequests(const model::ModelFile& model, std::size_t count, std::uint64_t seed)
    : waves_(2 * count * inference::segmentSamples) {
    inference::fillStandardNormal({.seed = seed, .voice = 0, .segment = 0}, waves_);
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> share(0.05, 0.95);
    std::uniform_int_distribution<std::size_t> label(0, model.header().labels.size() - 1);
    requests_.reserve(count);
    for (std::size_t index = 0; index < count; ++index) {
        using Wave = std::span<const float, inference::segmentSamples>;
        const float* waves = waves_.data() + 2 * index * inference::segmentSamples;
        inference::SegmentRequest request{
            .embedding = {},
            .motion = {static_cast<float>(model.header().speedMps.at(share(generator))), 0.0F,
                       static_cast<float>(model.header().forceNewtons.at(share(generator)))},
            .previous = Wave(waves, inference::segmentSamples),
            .noise = Wave(waves + inference::segmentSamples, inference::segmentSamples)};
        const auto embedding = model.embedding(label(generator));
        std::copy(embedding.begin(), embedding.end(), request.embedding.begin());
        request.phases = skeleton::phasesOf(request.embedding, request.motion, {});
        requests_.push_back(request);
    }
}

std::span<const inference::SegmentRequest> RandomRequests::next(std::size_t count) {
    if (at_ + count > requests_.size()) {
        at_ = 0;
    }
    const auto chosen = std::span(requests_).subspan(at_, count);
    at_ += count;
    return chosen;
}

}  // namespace haptoflow::bench
