#include "capi/handles.hpp"

#include "inference/tier_graphs.hpp"

#include <stdexcept>

namespace haptoflow::capi {

std::shared_ptr<const inference::Runtime> runtimeOf(const haptoflow_runtime* runtime) {
    return runtime != nullptr ? runtimes().get(runtime) : nullptr;
}

const model::Tier& tierNamed(const model::ModelFile& model, const char* name) {
    if (name == nullptr) {
        return model.header().tiers[model.header().defaultTier];
    }
    const model::Tier* tier = model.findTier(name);
    if (tier == nullptr) {
        throw std::invalid_argument(std::string("options: the model has no tier \"") + name + '"');
    }
    return *tier;
}

inference::LoadLimits loadLimits(const haptoflow_cancellation* cancellation, double probeLimitMs) {
    inference::LoadLimits limits;
    if (probeLimitMs != 0.0) {
        if (!(probeLimitMs > 0.0 && probeLimitMs <= inference::maximumProbeLimitMs)) {
            throw std::invalid_argument("options: probe_limit_ms is " + std::to_string(probeLimitMs) +
                                        "; expected above 0 to 3600000, or 0 for 10000");
        }
        limits.probeLimitMs = probeLimitMs;
    }
    if (cancellation != nullptr) {
        limits.cancellation = cancellations().get(cancellation);
    }
    return limits;
}

std::unique_ptr<inference::SegmentGenerator> TierLoader::load(std::size_t tier,
                                                              const inference::LoadLimits& limits) const {
    const model::Tier& wanted = model->model.header().tiers.at(tier);
    return inference::makeGenerator(runtime, model->model, wanted, inference::defaultSolver(wanted), batch, limits,
                                    model->native, sessions.get());
}

std::unique_ptr<inference::LevelEstimator> TierLoader::loadLevels(std::size_t tier,
                                                                  const inference::LoadLimits& limits) const {
    return inference::makeLevelEstimator(runtime, model->model, model->model.header().tiers.at(tier), limits,
                                         model->native);
}

haptoflow_label_info describe(const model::Label& label) {
    haptoflow_label_info info{};
    info.is_periodic = label.wavelengthMetres ? 1 : 0;
    info.name = label.name.c_str();
    info.category = label.category.c_str();
    info.stiffness_newtons_per_metre = label.stiffnessNewtonsPerMetre;
    info.friction_coefficient = label.frictionCoefficient;
    info.wavelength_metres = label.wavelengthMetres.value_or(0.0);
    info.speed_level_exponent = label.speedLevelExponent;
    info.force_level_exponent = label.forceLevelExponent;
    info.frequency_exponent = label.frequencyExponent;
    return info;
}

}  // namespace haptoflow::capi
