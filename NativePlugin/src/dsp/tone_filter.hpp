#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <vector>

namespace haptoflow::dsp {

/// Natural logarithm of the amplitude ratio that 1 dB stands for.
inline constexpr double nepersPerDecibel = std::numbers::ln10 / 20.0;

inline constexpr std::size_t toneTaps = 64;

/// Impulse response of a tone: a minimum-phase filter at the waveform rate.
using ToneKernel = std::array<float, toneTaps>;

/// The first coefficients of a minimum-phase filter's complex cepstrum. Adding cepstra multiplies the filters'
/// magnitudes, and a mean of cepstra is the filter with the mean gain in dB; so tones are mixed as cepstra and turned
/// into kernels afterwards.
using ToneCepstrum = std::array<double, toneTaps>;

/// Gain in dB at a frequency in Hz.
using ToneGain = std::function<double(double frequencyHz)>;

/// Cepstrum of the tone with the gain `gainDb`, which is evaluated at 129 frequencies from 0 to 1,000 Hz. Allocates.
[[nodiscard]] ToneCepstrum toneCepstrum(const ToneGain& gainDb);

/// Kernel of a cepstrum. A gain of 0 dB at all frequencies gives a unit impulse without delay. Allocates nothing.
[[nodiscard]] ToneKernel toneKernel(const ToneCepstrum& cepstrum) noexcept;

/// The resampler's interpolation kernel h(t) for 0 <= t < lengthInputSamples, t in input samples: a Kaiser-windowed
/// sinc (passband to 0.45, stopband from 0.55 of the input rate), converted to minimum phase through its real cepstrum.
/// It has the magnitude of the linear-phase kernel with the least delay: at 2 kHz, 1.2-1.5 ms in the tactile band
/// instead of 13.5 ms.
class MinimumPhaseKernel {
public:
    static constexpr std::size_t lengthInputSamples = 56;

    /// The one kernel, designed at first use and immutable afterwards. The design allocates: not on the audio thread.
    [[nodiscard]] static const MinimumPhaseKernel& shared();

    /// h(t) by cubic interpolation of the design grid; 0 outside the kernel.
    [[nodiscard]] double at(double inputSamples) const noexcept;
    /// Group delay in input samples at `cyclesPerInputSample` (0 to 0.45).
    [[nodiscard]] double groupDelay(double cyclesPerInputSample) const noexcept;

private:
    MinimumPhaseKernel();

    std::vector<double> grid_;
};

/// Applies a tone to a waveform at 2 kHz. A change of kernel takes 10 ms, during which each tap moves linearly. Without
/// a tone the filter does not run. Audio thread: allocates nothing, waits for nothing.
class ToneFilter {
public:
    static constexpr std::size_t memorySamples = toneTaps - 1;
    static constexpr std::size_t fadeSamples = 20;

    /// Starts the change to `kernel` (null for no tone). `past` holds the samples played last; they fill the filter's
    /// memory if it was not running.
    void setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept;
    /// Changes to `kernel` at once and clears the memory, for a new waveform.
    void reset(const ToneKernel* kernel) noexcept;

    /// False if `process` would change nothing.
    [[nodiscard]] bool isActive() const noexcept { return active_; }
    /// Whether the filter has `kernel` or is changing to it.
    [[nodiscard]] bool isTarget(const ToneKernel* kernel) const noexcept;
    void process(std::span<float> samples) noexcept;

private:
    void settle() noexcept;

    bool active_ = false;
    /// Whether the target is a tone.
    bool hasTone_ = false;
    ToneKernel from_{};
    ToneKernel to_{};
    std::size_t fadeRemaining_ = 0;
    /// Past input samples, the newest first.
    std::array<float, memorySamples> memory_{};
};

}  // namespace haptoflow::dsp
