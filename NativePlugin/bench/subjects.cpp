#include "bench/subjects.hpp"

#include "bench/bench_plan.hpp"
#include "inference/gaussian_noise.hpp"
#include "inference/tier_graphs.hpp"
#include "skeleton/rib_rates.hpp"

#include <algorithm>
#include <random>
#include <utility>

namespace haptoflow::bench {
namespace {

double within(const model::TrainedInterval& range, double share) {
    return range.minimum + share * (range.maximum - range.minimum);
}

}  // namespace

const model::Tier& Subjects::standard() const {
    const model::Tier* named = model->findTier("standard");
    return named != nullptr ? *named : model->header().tiers[model->header().defaultTier];
}

std::unique_ptr<inference::TierGenerator> Subjects::generator(const model::ModelFile& file, const model::Tier& tier,
                                                              std::size_t batch) const {
    return inference::makeGenerator(runtime, file, tier, inference::defaultSolver(tier), batch);
}

std::unique_ptr<engine::LiveEngine> Subjects::engineWith(std::unique_ptr<inference::SegmentGenerator> generator,
                                                         bool hasWorker, const skeleton::NativeParts& native) const {
    engine::LiveEngineSettings settings;
    settings.quality.fixedTier = 0;
    settings.updateRateHz = updateRateHz;
    settings.seed = seed;
    settings.hasWorker = hasWorker;
    settings.native = native;
    engine::EngineTiers tiers;
    tiers.push_back(std::move(generator));
    return std::make_unique<engine::LiveEngine>(model, std::move(tiers), 0, settings);
}

std::unique_ptr<engine::LiveEngine> Subjects::standardEngine(bool hasWorker) const {
    return engineWith(generator(*model, standard(), defaultBatch), hasWorker);
}

Hand::Hand(const model::ModelFile& model)
    : speedMps_(model.header().speedMps), forceNewtons_(model.header().forceNewtons) {
    const auto add = [this](std::size_t index) {
        const auto label = static_cast<std::uint32_t>(index);
        if (labels_.size() < maximumLabels && std::ranges::find(labels_, label) == labels_.end()) {
            labels_.push_back(label);
        }
    };
    if (model.header().skeleton) {
        for (std::size_t label = 0; label < model.header().labels.size(); ++label) {
            add(label);
        }
    }
    for (const model::SeedEntry& seed : model.header().seeds) {
        add(seed.label);
    }
    std::ranges::sort(labels_);
}

engine::ContactState Hand::sliding(std::uint32_t touch, std::size_t place, double speedShare) const {
    engine::ContactState state;
    state.touching = true;
    state.touchCounter = touch;
    state.velocityMps = {static_cast<float>(within(speedMps_, speedShare)), 0.0F};
    state.forceNewtons = static_cast<float>(within(forceNewtons_, 0.3));
    state.material.add(label(place), 1.0F);
    return state;
}

engine::ContactState Hand::lifted(std::uint32_t touch) {
    engine::ContactState state;
    state.touchCounter = touch;
    return state;
}

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
            .motion = {static_cast<float>(within(model.header().speedMps, share(generator))), 0.0F,
                       static_cast<float>(within(model.header().forceNewtons, share(generator)))},
            .previous = Wave(waves, inference::segmentSamples),
            .noise = Wave(waves + inference::segmentSamples, inference::segmentSamples)};
        std::ranges::copy(model.embedding(label(generator)), request.embedding.begin());
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
