#include "dsp/tone_filter.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace haptoflow::dsp {
namespace {

constexpr std::size_t cepstrumLength = 256;

using Complex = std::complex<double>;

// With this grid the error of cubic interpolation is below -110 dB.
constexpr std::size_t gridPerInputSample = 32;
constexpr std::size_t halfLength = 27;
constexpr double attenuationDecibels = 84.0;
// 18 times the kernel's length, so that cepstral aliasing stays below the stopband.
constexpr std::size_t transformLength = std::size_t{1} << 15;
// Keeps the logarithm finite at the zeros of the stopband.
constexpr double magnitudeFloor = 1e-6;

std::vector<Complex> linearPhasePrototype() {
    const double beta = kaiserBeta(attenuationDecibels);
    const auto half = static_cast<double>(halfLength);
    std::vector<Complex> prototype(transformLength);
    for (std::size_t i = 0; i <= 2 * halfLength * gridPerInputSample; ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(gridPerInputSample) - half;
        prototype[i] = normalisedSinc(t) * kaiserWindow(t / half, beta);
    }
    return prototype;
}

constexpr ToneKernel unitImpulse = [] {
    ToneKernel kernel{};
    kernel[0] = 1.0F;
    return kernel;
}();

const ToneKernel& orUnitImpulse(const ToneKernel* kernel) noexcept {
    return kernel == nullptr ? unitImpulse : *kernel;
}

float remainingShare(std::size_t fadeLeft) noexcept {
    return static_cast<float>(fadeLeft) / static_cast<float>(ToneFilter::fadeSamples);
}

}  // namespace

ToneCepstrum toneCepstrum(const ToneGain& gainDb) {
    std::vector<std::complex<double>> values(cepstrumLength);
    for (std::size_t i = 0; i <= cepstrumLength / 2; ++i) {
        const double frequencyHz = static_cast<double>(i) * waveformRateHz / static_cast<double>(cepstrumLength);
        values[i] = gainDb(frequencyHz) * nepersPerDecibel;
        values[(cepstrumLength - i) % cepstrumLength] = values[i];
    }
    fourierTransform(values, Direction::inverse);
    ToneCepstrum cepstrum{};
    for (std::size_t i = 0; i < cepstrum.size(); ++i) {
        // Folded: see minimumPhaseResponse.
        cepstrum[i] = (i == 0 ? 1.0 : 2.0) * values[i].real();
    }
    return cepstrum;
}

ToneKernel toneKernel(const ToneCepstrum& cepstrum) noexcept {
    std::array<double, toneTaps> response{};
    minimumPhaseResponse(cepstrum, response);
    ToneKernel kernel{};
    for (std::size_t n = 0; n < kernel.size(); ++n) {
        kernel[n] = static_cast<float>(response[n]);
    }
    return kernel;
}

const MinimumPhaseKernel& MinimumPhaseKernel::shared() {
    static const MinimumPhaseKernel kernel;
    return kernel;
}

// By the folded cepstrum of log |H|: see minimumPhaseResponse.
MinimumPhaseKernel::MinimumPhaseKernel() {
    std::vector<Complex> values = linearPhasePrototype();
    fourierTransform(values, Direction::forward);
    const double floor = magnitudeFloor * std::abs(values[0]);
    for (Complex& value : values) {
        value = std::log(std::max(std::abs(value), floor));
    }
    fourierTransform(values, Direction::inverse);
    for (std::size_t i = 1; i < transformLength / 2; ++i) {
        values[i] *= 2.0;
        values[transformLength - i] = 0.0;
    }
    fourierTransform(values, Direction::forward);
    for (Complex& value : values) {
        value = std::exp(value);
    }
    fourierTransform(values, Direction::inverse);

    grid_.resize(lengthInputSamples * gridPerInputSample);
    double sum = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        grid_[i] = values[i].real();
        sum += grid_[i];
    }
    for (double& value : grid_) {
        value *= static_cast<double>(gridPerInputSample) / sum;
    }
}

double MinimumPhaseKernel::at(double inputSamples) const noexcept {
    if (!(inputSamples >= 0.0) || inputSamples >= static_cast<double>(lengthInputSamples)) {
        return 0.0;
    }
    const double position = inputSamples * static_cast<double>(gridPerInputSample);
    const auto index = static_cast<std::ptrdiff_t>(position);
    const double x = position - static_cast<double>(index);
    const auto point = [&](std::ptrdiff_t offset) {
        const std::ptrdiff_t i = index + offset;
        return i >= 0 && i < std::ssize(grid_) ? grid_[static_cast<std::size_t>(i)] : 0.0;
    };
    return point(-1) * (-x * (x - 1.0) * (x - 2.0) / 6.0) + point(0) * ((x + 1.0) * (x - 1.0) * (x - 2.0) / 2.0) +
           point(1) * (-(x + 1.0) * x * (x - 2.0) / 2.0) + point(2) * ((x + 1.0) * x * (x - 1.0) / 6.0);
}

double MinimumPhaseKernel::groupDelay(double cyclesPerInputSample) const noexcept {
    Complex response = 0.0;
    Complex delayed = 0.0;
    for (std::size_t i = 0; i < grid_.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(gridPerInputSample);
        const Complex value = std::polar(1.0, -2.0 * std::numbers::pi * cyclesPerInputSample * t) * grid_[i];
        response += value;
        delayed += value * t;
    }
    return (delayed / response).real();
}

bool ToneFilter::isTarget(const ToneKernel* kernel) const noexcept {
    return hasTone_ == (kernel != nullptr) && (kernel == nullptr || to_ == *kernel);
}

void ToneFilter::setTone(const ToneKernel* kernel, std::span<const float, memorySamples> past) noexcept {
    if (isTarget(kernel)) {
        return;
    }
    if (!active_) {
        from_ = unitImpulse;
        std::ranges::reverse_copy(past, memory_.begin());
        active_ = true;
    } else {
        // Start from the present kernel, which may be in the middle of an earlier change.
        const float left = remainingShare(fadeRemaining_);
        for (std::size_t tap = 0; tap < toneTaps; ++tap) {
            from_[tap] = to_[tap] + left * (from_[tap] - to_[tap]);
        }
    }
    hasTone_ = kernel != nullptr;
    to_ = orUnitImpulse(kernel);
    fadeRemaining_ = fadeSamples;
}

void ToneFilter::reset(const ToneKernel* kernel) noexcept {
    hasTone_ = kernel != nullptr;
    active_ = hasTone_;
    to_ = orUnitImpulse(kernel);
    fadeRemaining_ = 0;
    memory_.fill(0.0F);
}

void ToneFilter::settle() noexcept {
    if (fadeRemaining_ > 0) {
        --fadeRemaining_;
    }
    active_ = hasTone_ || fadeRemaining_ > 0;
}

void ToneFilter::process(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (!active_) {
            return;
        }
        float target = to_[0] * sample;
        float before = from_[0] * sample;
        for (std::size_t tap = 0; tap < memorySamples; ++tap) {
            target += to_[tap + 1] * memory_[tap];
            before += from_[tap + 1] * memory_[tap];
        }
        std::ranges::copy_backward(std::span(memory_).first(memorySamples - 1), memory_.end());
        memory_[0] = sample;
        sample = fadeRemaining_ > 0 ? target + remainingShare(fadeRemaining_) * (before - target) : target;
        settle();
    }
}

}  // namespace haptoflow::dsp
