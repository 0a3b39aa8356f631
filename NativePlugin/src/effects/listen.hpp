#pragma once

#include "effects/effect.hpp"
#include "effects/envelope_gain.hpp"

#include <array>
#include <span>

namespace haptoflow::effects {

/// Makes a vibration audible on loudspeakers: for ears, never for an actuator.
///
/// A texture at its true level lies some 40 dB below full scale, with most of its energy where a laptop's loudspeakers
/// play nothing. This effect brightens it by two shelves of 6 dB an octave from 150 to 1500 Hz, then brings the
/// envelope towards the full scale: an envelope E of the brightened wave becomes
///
///   middleShare * (E / E_m)^p of the full scale, bent above 0.7, at most 0.9.
///
/// A new one opens within a tenth of a second from a gain near 1, so that switching it on makes no click; `reset`, for
/// a silent voice, opens it at once.
///
/// The exponent keeps the order of labels and of forces. Delay: EnvelopeGain::latencySeconds. The limiter follows after
/// this effect. Finite and bounded for any input; reads no field of the contact.
class Listen final : public Effect {
public:
    /// `fullScaleMps2`: the acceleration that is +-1 at the output. Throws std::invalid_argument for a rate outside
    /// 8-192 kHz or a full scale that is not above 0.
    Listen(double sampleRateHz, double fullScaleMps2);

    [[nodiscard]] EffectDeclaration declaration() const noexcept override;
    void process(std::span<float> samplesMps2) noexcept override;
    void reset() noexcept override;
    [[nodiscard]] bool isIdle() const noexcept override;

private:
    /// y(n) = in0 x(n) + in1 x(n-1) + back y(n-1).
    struct Shelf {
        double in = 0.0;
        double out = 0.0;
    };

    [[nodiscard]] double brightened(double sample) noexcept;

    double in0_ = 0.0;
    double in1_ = 0.0;
    double back_ = 0.0;
    float fullScaleMps2_;
    std::array<Shelf, 2> shelves_{};
    EnvelopeGain gain_;
};

}  // namespace haptoflow::effects
