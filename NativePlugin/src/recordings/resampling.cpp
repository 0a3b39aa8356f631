#include "recordings/resampling.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>

namespace haptoflow::recordings {
namespace {

constexpr double attenuationDecibels = 66.0;
constexpr double halfLengthInZeros = 40.0;
constexpr std::size_t gridPerZero = 256;
constexpr std::size_t reflectedSamples = 1000;

/// The right half of the symmetric kernel, on a grid fine enough for linear interpolation.
std::vector<double> sincTable() {
    std::vector<double> table(static_cast<std::size_t>(halfLengthInZeros) * gridPerZero + 2);
    const double beta = dsp::kaiserBeta(attenuationDecibels);
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(gridPerZero);
        table[i] = dsp::normalisedSinc(t) * dsp::kaiserWindow(t / halfLengthInZeros, beta);
    }
    return table;
}

double eighthPower(double value) {
    const double square = value * value;
    const double fourth = square * square;
    return fourth * fourth;
}

}  // namespace

std::vector<double> resampled(const Channel& channel, double fromHz, double toHz) {
    const std::vector<double> table = sincTable();
    const double step = fromHz / toHz;
    const double zerosPerInput = std::min(1.0, 1.0 / step);
    const double reach = halfLengthInZeros / zerosPerInput;
    const auto inputs = static_cast<std::ptrdiff_t>(channel.count);
    std::vector<double> result(static_cast<std::size_t>(std::ceil(static_cast<double>(channel.count) / step)));
    for (std::size_t n = 0; n < result.size(); ++n) {
        const double centre = static_cast<double>(n) * step;
        const auto first = std::max<std::ptrdiff_t>(0, static_cast<std::ptrdiff_t>(std::ceil(centre - reach)));
        const auto last = std::min<std::ptrdiff_t>(inputs - 1, static_cast<std::ptrdiff_t>(std::floor(centre + reach)));
        double sum = 0.0;
        for (std::ptrdiff_t i = first; i <= last; ++i) {
            const double position =
                std::abs(static_cast<double>(i) - centre) * zerosPerInput * static_cast<double>(gridPerZero);
            const auto index = std::min(static_cast<std::size_t>(position), table.size() - 2);
            const double share = std::min(position - static_cast<double>(index), 1.0);
            sum += channel.at(static_cast<std::size_t>(i)) * (table[index] + share * (table[index + 1] - table[index]));
        }
        result[n] = sum * zerosPerInput;
    }
    return result;
}

std::vector<double> bandPassed(std::span<const double> values) {
    constexpr double highPassHz = 10.0;
    constexpr double lowPassHz = 1000.0;
    const std::size_t count = values.size();
    if (count == 0) {
        return {};
    }
    const std::size_t margin = std::min(reflectedSamples, count - 1);
    std::vector<std::complex<double>> spectrum(std::bit_ceil(count + 2 * reflectedSamples));
    for (std::size_t i = 0; i < count; ++i) {
        spectrum[margin + i] = values[i];
    }
    for (std::size_t i = 1; i <= margin; ++i) {
        spectrum[margin - i] = values[i];
        spectrum[margin + count - 1 + i] = values[count - 1 - i];
    }
    dsp::fourierTransform(spectrum, dsp::Direction::forward);
    const std::size_t size = spectrum.size();
    spectrum[0] = 0.0;
    for (std::size_t bin = 1; bin <= size / 2; ++bin) {
        const double hertz = static_cast<double>(bin) * dsp::waveformRateHz / static_cast<double>(size);
        const double gain = 1.0 / ((1.0 + eighthPower(highPassHz / hertz)) * (1.0 + eighthPower(hertz / lowPassHz)));
        spectrum[bin] *= gain;
        if (bin != size - bin) {
            spectrum[size - bin] *= gain;
        }
    }
    dsp::fourierTransform(spectrum, dsp::Direction::inverse);
    std::vector<double> result(count);
    for (std::size_t i = 0; i < count; ++i) {
        result[i] = spectrum[margin + i].real();
    }
    return result;
}

}  // namespace haptoflow::recordings
