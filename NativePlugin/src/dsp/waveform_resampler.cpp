#include "dsp/waveform_resampler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "dsp/sample_rates.hpp"
#include "dsp/tone_filter.hpp"

namespace haptoflow::dsp {
namespace {

constexpr std::size_t kernelLength = MinimumPhaseKernel::lengthInputSamples;
constexpr double rateResolution = 1048576.0;  // 2^20 per Hz
// Rates with more distinct phases interpolate between this many; the error is below (pi / 512)^2 / 8, -106 dB.
constexpr std::size_t maximumPhases = 512;

// Eight fixed partial sums: the compiler can vectorise them without changing the order of additions, so every machine
// gets the same result.
float dotProduct(const float* taps, const float* samples) noexcept {
    constexpr std::size_t lanes = 8;
    static_assert(kernelLength % lanes == 0);
    std::array<float, lanes> sums{};
    for (std::size_t i = 0; i < kernelLength; i += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            sums[lane] += taps[i + lane] * samples[i + lane];
        }
    }
    return ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
}

}  // namespace

WaveformResampler::WaveformResampler(double outputRateHz)
    : latencyInputSamples_(static_cast<std::size_t>(std::lround(MinimumPhaseKernel::shared().groupDelay(0.0)))),
      step_(static_cast<std::uint64_t>(std::llround(waveformRateHz * rateResolution))),
      period_(static_cast<std::uint64_t>(std::llround(requireOutputRate(outputRateHz) * rateResolution))),
      history_(2 * kernelLength) {
    const std::uint64_t common = std::gcd(step_, period_);
    step_ /= common;
    period_ /= common;
    exactPhases_ = period_ <= maximumPhases;
    phases_ = exactPhases_ ? static_cast<std::size_t>(period_) : maximumPhases;

    const MinimumPhaseKernel& kernel = MinimumPhaseKernel::shared();
    const std::size_t rows = phases_ + 1;
    taps_.resize(rows * kernelLength);
    for (std::size_t row = 0; row < rows; ++row) {
        const double offset = static_cast<double>(row) / static_cast<double>(phases_);
        for (std::size_t i = 0; i < kernelLength; ++i) {
            taps_[row * kernelLength + i] =
                static_cast<float>(kernel.at(offset + static_cast<double>(kernelLength - 1 - i)));
        }
    }
    reset();
}

double WaveformResampler::groupDelaySeconds(double frequencyHz) const noexcept {
    return MinimumPhaseKernel::shared().groupDelay(frequencyHz / waveformRateHz) / waveformRateHz;
}

std::size_t WaveformResampler::inputNeeded(std::size_t outputCount) const noexcept {
    return static_cast<std::size_t>((fraction_ + static_cast<std::uint64_t>(outputCount) * step_) / period_);
}

double WaveformResampler::samplesUntilNext() const noexcept {
    const std::uint64_t passed = fraction_ + step_;
    return passed < period_ ? static_cast<double>(period_ - passed) / static_cast<double>(period_) : 0.0;
}

void WaveformResampler::process(std::span<const float> input, std::span<float> output) noexcept {
    std::size_t consumed = 0;
    for (float& sample : output) {
        fraction_ += step_;
        if (fraction_ >= period_) {
            fraction_ -= period_;
            push(consumed < input.size() ? input[consumed] : 0.0F);
            ++consumed;
        }
        sample = interpolate();
    }
}

void WaveformResampler::reset() noexcept {
    std::fill(history_.begin(), history_.end(), 0.0F);
    writeIndex_ = 0;
    fraction_ = period_ - step_;  // the first output falls on the first input sample
}

void WaveformResampler::prime(std::span<const float> past) noexcept {
    reset();
    const std::span<const float> kept = past.last(std::min(past.size(), kernelLength));
    const auto missing = static_cast<std::ptrdiff_t>(kernelLength - kept.size());
    std::ranges::copy(kept, history_.begin() + missing);
    std::ranges::copy(kept, history_.begin() + missing + static_cast<std::ptrdiff_t>(kernelLength));
}

void WaveformResampler::push(float sample) noexcept {
    history_[writeIndex_] = sample;
    history_[writeIndex_ + kernelLength] = sample;
    writeIndex_ = writeIndex_ + 1 == kernelLength ? 0 : writeIndex_ + 1;
}

float WaveformResampler::interpolate() const noexcept {
    const float* samples = history_.data() + writeIndex_;
    if (exactPhases_) {
        return dotProduct(taps_.data() + static_cast<std::size_t>(fraction_) * kernelLength, samples);
    }
    const double phase = static_cast<double>(fraction_) * static_cast<double>(phases_) / static_cast<double>(period_);
    const std::size_t row = std::min(static_cast<std::size_t>(phase), phases_ - 1);
    const auto weight = static_cast<float>(phase - static_cast<double>(row));
    const float* taps = taps_.data() + row * kernelLength;
    const float lower = dotProduct(taps, samples);
    return lower + weight * (dotProduct(taps + kernelLength, samples) - lower);
}

}  // namespace haptoflow::dsp
