#include "recordings/short_time_spectrum.hpp"

#include "dsp/fourier_transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace haptoflow::recordings {
namespace {

using Complex = std::complex<double>;
using Window = std::array<double, ShortTimeSpectrum::frameSamples>;

Window squareRootHann() {
    Window window{};
    for (std::size_t i = 0; i < window.size(); ++i) {
        window[i] = std::sin(std::numbers::pi * static_cast<double>(i) / static_cast<double>(window.size()));
    }
    return window;
}

}  // namespace

ShortTimeSpectrum::ShortTimeSpectrum(std::span<const float> wave) : samples_(wave.size()) {
    const Window window = squareRootHann();
    const std::size_t frames = (samples_ + hop - 1) / hop + 1;
    values_.reserve(frames * bins);
    std::vector<Complex> frame(frameSamples);
    for (std::size_t each = 0; each < frames; ++each) {
        for (std::size_t i = 0; i < frameSamples; ++i) {
            const std::size_t sample = each * hop + i;
            const bool isInside = sample >= hop && sample - hop < samples_;
            frame[i] = isInside ? window[i] * static_cast<double>(wave[sample - hop]) : 0.0;
        }
        dsp::fourierTransform(frame, dsp::Direction::forward);
        values_.insert(values_.end(), frame.begin(), frame.begin() + bins);
    }
}

SpectrumCells ShortTimeSpectrum::power() const {
    SpectrumCells cells(values_.size());
    std::ranges::transform(values_, cells.begin(), [](const Complex& value) { return std::norm(value); });
    return cells;
}

void ShortTimeSpectrum::scale(const SpectrumCells& gains) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
        values_[i] *= gains[i];
    }
}

std::vector<float> ShortTimeSpectrum::wave() const {
    const Window window = squareRootHann();
    std::vector<double> sum((frames() + 1) * hop);
    std::vector<Complex> frame(frameSamples);
    for (std::size_t each = 0; each < frames(); ++each) {
        const auto first = values_.begin() + static_cast<std::ptrdiff_t>(each * bins);
        std::copy_n(first, bins, frame.begin());
        for (std::size_t bin = 1; bin + 1 < bins; ++bin) {
            frame[frameSamples - bin] = std::conj(frame[bin]);
        }
        dsp::fourierTransform(frame, dsp::Direction::inverse);
        for (std::size_t i = 0; i < frameSamples; ++i) {
            sum[each * hop + i] += window[i] * frame[i].real();
        }
    }
    std::vector<float> wave(samples_);
    std::transform(sum.begin() + hop, sum.begin() + static_cast<std::ptrdiff_t>(hop + samples_), wave.begin(),
                   [](double value) { return static_cast<float>(value); });
    return wave;
}

double ShortTimeSpectrum::meanSquare(std::span<const double> power) {
    double sum = 0.0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        sum += (bin == 0 || bin + 1 == bins ? 1.0 : 2.0) * power[bin];
    }
    constexpr double windowEnergy = 0.5 * frameSamples;
    return sum / (static_cast<double>(frameSamples) * windowEnergy);
}

}  // namespace haptoflow::recordings
