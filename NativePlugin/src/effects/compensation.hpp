#pragma once

#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"
#include "effects/parallel_filter.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace haptoflow::effects {

struct CompensationSettings {
    /// Maximum gain at any frequency, 0 to 24 dB.
    double maximumBoostDecibels = 12.0;
    /// Lower and upper edge of the compensated band, within 20 to 1000 Hz. Frequencies outside the profile are left
    /// out.
    std::array<double, 2> bandHz{50.0, 1000.0};
};

/// Compensates an actuator's frequency response with a minimum-phase, regularised inverse of its magnitude.
///
/// - Gain: the boost is limited, and it decreases where the actuator has almost no output, so that no power is spent
///   where nothing would be felt. No frequency is attenuated by more than `maximumCutDecibels`.
/// - Band: an octave outside the band the gain is 0 dB. A profile without a point in the band changes nothing.
/// - Level: white noise and pink noise from 20 to 1000 Hz do not gain power, so a broadband texture keeps its headroom.
///   A texture with its energy where the actuator is weak gets louder, by the maximum boost at most; the limiter after
///   this effect handles that case.
/// - Delay: there is no look-ahead and no bulk delay. The latency is the largest group delay in the band. An
///   actuator that is itself minimum-phase cancels this delay where it is fully compensated.
///
/// The number of filter sections and the cost per sample are the same at every rate.
class Compensation final : public Effect {
public:
    static constexpr double maximumCutDecibels = 24.0;

    /// Designs the filter, which takes some milliseconds and allocates: not on the audio thread. Throws
    /// std::invalid_argument for a rate outside 8-192 kHz and for settings out of range.
    Compensation(const ActuatorProfile& profile, double sampleRateHz, const CompensationSettings& settings = {});

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return isIdle_; }

    /// True if the profile needs no compensation: `process` leaves every sample unchanged.
    [[nodiscard]] bool isTransparent() const noexcept { return !filter_.has_value(); }
    /// Gain and group delay of the realised filter at a frequency. Any thread.
    [[nodiscard]] double gainDecibels(double frequencyHz) const noexcept;
    [[nodiscard]] double groupDelaySeconds(double frequencyHz) const noexcept;
    /// The magnitude, in the profile's decibels, to which the actuator is levelled in the band.
    [[nodiscard]] double levelDecibels() const noexcept { return levelDecibels_; }
    /// The largest group delay in the band, and for how long the filter sounds after its input.
    [[nodiscard]] double latencySeconds() const noexcept { return latencySeconds_; }
    [[nodiscard]] double tailSeconds() const noexcept { return tailSeconds_; }
    /// The part of the band that the profile covers.
    [[nodiscard]] std::array<double, 2> bandHz() const noexcept { return bandHz_; }

private:
    std::array<double, 2> bandHz_;
    double levelDecibels_ = 0.0;
    double latencySeconds_ = 0.0;
    double tailSeconds_ = 0.0;
    std::optional<ParallelFilter> filter_;
    bool isIdle_ = true;
};

}  // namespace haptoflow::effects
