#pragma once

#include "effects/actuator_profile.hpp"
#include "engine/effect_stage.hpp"

#include <cstdint>
#include <memory>

namespace haptoflow::engine {

/// The processors that a voice uses.
struct ProcessorSettings {
    /// Increases by 1 at each change; 0 if there was never a change.
    std::uint64_t version = 0;
    bool hasDelay = false;
    bool hasExposureGuard = false;
    /// Profile of the actuator to compensate; null for no compensation.
    std::shared_ptr<const effects::ActuatorProfile> actuator;
    /// Acceleration that is +-1 at the output of a voice that is made audible; 0 for a voice that is not.
    double listenFullScaleMps2 = 0.0;
};

/// Designs and allocates the processors, which takes milliseconds: not on the audio thread. Null for version 0. With
/// `keepsExposure` there is a guard even if the settings switch it off, for the exposure that it has measured. Throws
/// std::invalid_argument for a rate outside 8-192 kHz, std::bad_alloc.
[[nodiscard]] std::unique_ptr<Processors> makeProcessors(const ProcessorSettings& settings, double rateHz,
                                                         double delaySeconds, double actuatorGain, bool keepsExposure);

}  // namespace haptoflow::engine
