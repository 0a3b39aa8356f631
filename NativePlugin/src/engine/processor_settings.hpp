#pragma once

#include "effects/actuator_profile.hpp"
#include "engine/effect_stage.hpp"

#include <cstdint>
#include <memory>

namespace haptoflow::engine {

/// Which processors a voice asks for.
struct ProcessorSettings {
    /// One more at each change; 0 while nothing was ever asked for.
    std::uint64_t version = 0;
    bool hasDelay = false;
    bool hasExposureGuard = false;
    /// What is compensated; null for none.
    std::shared_ptr<const effects::ActuatorProfile> actuator;
};

/// Designs and allocates: milliseconds, on a thread that can wait. Null where nothing was ever asked for. Throws
/// std::invalid_argument for a rate outside 8-192 kHz, std::bad_alloc.
[[nodiscard]] std::unique_ptr<Processors> makeProcessors(const ProcessorSettings& settings, double rateHz,
                                                         double delaySeconds, double actuatorGain);

}  // namespace haptoflow::engine
