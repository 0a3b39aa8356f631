#pragma once

#include "effects/actuator_profile.hpp"
#include "effects/effect.hpp"
#include "effects/parallel_filter.hpp"

#include <array>
#include <cstddef>
#include <optional>

namespace haptoflow::effects {

struct CompensationSettings {
    /// No frequency is raised by more than this, 0 to 24 dB.
    double largestBoostDecibels = 12.0;
    /// Where the actuator is compensated, rising, 20 to 1000 Hz. The part that the profile does not cover is left out.
    std::array<double, 2> bandHz{50.0, 1000.0};
};

/// Makes an actuator play what was meant: the regularised inverse of its magnitude, minimum-phase.
///
/// - The boost is bounded, and where the actuator gives next to nothing it falls again: no power goes where nothing
///   would be felt. Nothing is lowered by more than `maximumCutDecibels`.
/// - An octave outside of the band the gain is back at 0 dB. A profile without a point in the band changes
///   nothing.
/// - Level: white noise and pink noise of 20 to 1000 Hz leave with at most the power that they came with, so that a
///   broadband texture keeps its headroom. A texture whose energy lies where the actuator is weak gets louder, by the
///   bounded boost at most; the limiter behind is for that.
/// - No look-ahead and no bulk delay. The group delay that its response brings is declared as latency, the largest in
///   the band; an actuator that is minimum-phase itself takes it back where it is compensated in full.
///
/// Fields of the contact: none. The sections and their cost are the same at every rate.
class Compensation final : public Effect {
public:
    static constexpr double maximumCutDecibels = 24.0;

    /// Designs the filter: some milliseconds, on a thread that can wait; allocates. Throws std::invalid_argument for a
    /// rate outside 8-192 kHz and for settings out of their range.
    Compensation(const ActuatorProfile& profile, double sampleRateHz, const CompensationSettings& settings = {});

    [[nodiscard]] EffectDeclaration declaration() const noexcept override;
    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override;

    /// True where the profile asks for no change: `process` leaves every sample as it is.
    [[nodiscard]] bool isTransparent() const noexcept { return !filter_.has_value(); }
    /// What it does at a frequency, as realised. Any thread.
    [[nodiscard]] double gainDecibels(double frequencyHz) const noexcept;
    [[nodiscard]] double groupDelaySeconds(double frequencyHz) const noexcept;
    /// The magnitude, in the profile's decibels, to which the actuator is levelled in the band.
    [[nodiscard]] double levelDecibels() const noexcept { return levelDecibels_; }
    /// The band after what the profile does not cover was left out.
    [[nodiscard]] std::array<double, 2> bandHz() const noexcept { return bandHz_; }

private:
    void measureLatency() noexcept;

    std::array<double, 2> bandHz_;
    double levelDecibels_ = 0.0;
    double latencySeconds_ = 0.0;
    double tailSeconds_ = 0.0;
    std::optional<ParallelFilter> filter_;
    bool isIdle_ = true;
};

}  // namespace haptoflow::effects
