#include "bench/subjects.hpp"

#include "bench/bench_plan.hpp"
#include "inference/tier_generator.hpp"

#include <algorithm>
#include <utility>

namespace haptoflow::bench {

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
    state.velocityMps = {static_cast<float>(speedMps_.at(speedShare)), 0.0F};
    state.forceNewtons = static_cast<float>(forceNewtons_.at(0.3));
    state.material.add(label(place), 1.0F);
    return state;
}

engine::ContactState Hand::lifted(std::uint32_t touch) {
    engine::ContactState state;
    state.touchCounter = touch;
    return state;
}

}  // namespace haptoflow::bench
