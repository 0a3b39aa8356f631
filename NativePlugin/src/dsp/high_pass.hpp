#pragma once

#include "dsp/sample_rates.hpp"

#include <span>

namespace haptoflow::dsp {

/// Removes from a 2 kHz waveform what lies below the recordings' band, which begins at 10 Hz: no filter that is fitted
/// to them knows that nothing was there. Butterworth of the second order at 7 Hz: -9.8 dB at 4 Hz, -0.9 dB at 10 Hz,
/// -0.1 dB at 20 Hz; it also removes a constant. Used by one thread; allocates nothing.
class HighPass {
public:
    HighPass() noexcept;

    void process(std::span<float> samples) noexcept;
    /// Forgets the past.
    void reset() noexcept { first_ = second_ = 0.0; }

private:
    double gain_;
    double feedback1_;
    double feedback2_;
    double first_ = 0.0;
    double second_ = 0.0;
};

}  // namespace haptoflow::dsp
