#pragma once

#include "dsp/gate.hpp"
#include "effects/effect.hpp"
#include "effects/relief_map.hpp"

#include <array>
#include <cstddef>
#include <span>

namespace haptoflow::effects {

/// What a contact state says of the relief under the tip.
struct ReliefContact {
    /// Null for none. Must live until the next contact or `keep`.
    const ReliefMap* map = nullptr;
    /// Place in the map, 0 to 1 over it, and when the tip is to be there: so long after the next sample.
    std::array<double, 2> place{};
    double arrivalSeconds = 0.0;
    /// Speed over the surface.
    double speedMps = 0.0;
    double forceNewtons = 0.0;
    /// What the relief may add at most.
    double largestMps2 = 0.0;
    /// Of the contact's spring, that of the material.
    double stiffnessNewtonsPerMetre = 1500.0;
};

/// A tip of 15 g, pressed on the spring of its contact, that follows the heights of a map along its path:
/// m z'' = max(0, k d + c (H' - z')) - F with d = H - z while d > 0, z being the tip's height. What it adds is z'',
/// from 10 Hz to 800 Hz.
///
/// Below the resonance of the contact (42 Hz on wood, 77 Hz on brick), a sine of amplitude A and wavelength L gives A
/// (2 pi v / L)^2. What is small beside `largestMps2` is heard as it is; what is large approaches it, so that a step
/// deeper than any motor's reach leaves the texture its share.
///
/// The path leads straight from place to place, each reached when the next is told: what a hand really did, one state
/// late. Where none is told, it goes on for as long again. Heights rise no faster than a
/// ball rolls over an edge, sqrt(2) times the speed, so that no map, no jump and no exchanged map gives more than a
/// blow of that speed. Another stiffness keeps the force of the spring. Semi-implicit Euler at 24 kHz or more. Bounded
/// for every input. Construction excepted, everything runs on the audio thread.
class Relief final : public Effect {
public:
    static constexpr double tipKilograms = 0.015;
    /// A tip sinks into what is softer until it is as stiff.
    static constexpr double leastStiffness = 400.0;
    static constexpr double mostStiffness = 10000.0;
    static constexpr double dampingRatio = 0.4;

    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit Relief(double sampleRateHz);

    /// Goes on with a contact from the next sample on; one without a map ends the relief within 5 ms. Numbers that are
    /// not finite count as 0.
    void follow(const ReliefContact& contact) noexcept;

    /// Ends the relief within 5 ms unless it follows this map: another one may be freed from now on.
    void keep(const ReliefMap* map) noexcept;

    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override { return isIdle_; }

private:
    /// Two poles and two zeros, in double precision because they lie near 1.
    class Section {
    public:
        enum class Kind { highPass, lowPass };
        Section(Kind kind, double frequencyHz, double quality, double rateHz) noexcept;
        [[nodiscard]] double next(double sample) noexcept;
        void reset() noexcept { first_ = second_ = 0.0; }

    private:
        std::array<double, 3> forward_{};
        std::array<double, 2> back_{};
        double first_ = 0.0;
        double second_ = 0.0;
    };

    void end() noexcept;
    void settle() noexcept;
    [[nodiscard]] double nextAcceleration() noexcept;

    double rateHz_;
    std::size_t steps_;
    double stepsPerSecond_;
    double stepSeconds_;
    double damping_ = 0.0;
    dsp::Gate gate_;
    Section highPass_;
    std::array<Section, 2> lowPass_;

    ReliefContact contact_;
    double forceNewtons_ = 0.0;
    std::array<double, 2> place_{};
    std::array<double, 2> placePerStep_{};
    std::size_t stepsLeft_ = 0;
    // Of this contact and the one before, because the tip is between their places.
    double speedMps_ = 0.0;
    double resolution_ = 0.0;
    double surfaceMetres_ = 0.0;
    double tipMetres_ = 0.0;
    double tipMps_ = 0.0;
    double quietSeconds_ = 0.0;
    double jump_ = 0.0;
    double newest_ = 0.0;
    bool isIdle_ = true;
};

}  // namespace haptoflow::effects
