#pragma once

#include <cstddef>
#include <vector>

namespace haptoflow::dsp {

/// The resampler's interpolation kernel h(t), t in input samples, 0 <= t < lengthInputSamples: a Kaiser-windowed
/// sinc (passband to 0.45, stopband from 0.55 of the input rate) made minimum-phase through its real cepstrum.
/// The magnitude stays the linear-phase one's; the energy comes as early as that magnitude allows, which at 2 kHz
/// takes the delay of the tactile band from 13.5 ms to 1.2-1.5 ms.
class MinimumPhaseKernel {
public:
    static constexpr std::size_t lengthInputSamples = 56;

    /// Designed once, at first use; construction allocates, so not on the audio thread. Immutable afterwards.
    [[nodiscard]] static const MinimumPhaseKernel& shared();

    /// h(t), by cubic interpolation of the design grid; 0 outside the kernel.
    [[nodiscard]] double at(double inputSamples) const noexcept;
    /// Group delay in input samples at `cyclesPerInputSample` (0 to 0.45).
    [[nodiscard]] double groupDelay(double cyclesPerInputSample) const noexcept;

private:
    MinimumPhaseKernel();

    std::vector<double> grid_;
};

}  // namespace haptoflow::dsp
