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

}  // namespace haptoflow::capi
