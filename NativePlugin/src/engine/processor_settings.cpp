#include "engine/processor_settings.hpp"

#include "effects/compensation.hpp"
#include "effects/listen.hpp"

namespace haptoflow::engine {

std::unique_ptr<Processors> makeProcessors(const ProcessorSettings& settings, double rateHz, double delaySeconds,
                                           double actuatorGain, bool keepsExposure) {
    if (settings.version == 0) {
        return nullptr;
    }
    auto made = std::make_unique<Processors>();
    made->version = settings.version;
    made->rateHz = rateHz;
    if (settings.hasDelay) {
        made->delay = std::make_unique<effects::Delay>(rateHz);
        made->delay->setDelaySeconds(delaySeconds);
    }
    if (settings.actuator != nullptr) {
        made->compensation = std::make_unique<effects::Compensation>(*settings.actuator, rateHz);
    }
    if (settings.listenFullScaleMps2 > 0.0) {
        made->listen = std::make_unique<effects::Listen>(rateHz, settings.listenFullScaleMps2);
    }
    if (settings.hasExposureGuard || keepsExposure) {
        made->exposureGuard = std::make_unique<effects::ExposureGuard>(rateHz);
        made->exposureGuard->switchOn(settings.hasExposureGuard);
        made->exposureGuard->setActuatorGain(actuatorGain);
    }
    return made;
}

}  // namespace haptoflow::engine
