#include "dsp/tone_cepstrum.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"

#include <cmath>
#include <complex>
#include <vector>

namespace haptoflow::dsp {
namespace {

constexpr std::size_t transformLength = 256;

}  // namespace

ToneCepstrum toneCepstrum(const ToneGain& gainDb) {
    std::vector<std::complex<double>> values(transformLength);
    for (std::size_t i = 0; i <= transformLength / 2; ++i) {
        const double frequencyHz = static_cast<double>(i) * waveformRateHz / static_cast<double>(transformLength);
        values[i] = gainDb(frequencyHz) * nepersPerDecibel;
        values[(transformLength - i) % transformLength] = values[i];
    }
    fourierTransform(values, Direction::inverse);
    ToneCepstrum cepstrum{};
    for (std::size_t i = 0; i < cepstrum.size(); ++i) {
        // Folding the cepstrum onto positive time makes the filter minimum-phase (Oppenheim and Schafer,
        // "Discrete-Time Signal Processing", chapter on homomorphic filtering).
        cepstrum[i] = (i == 0 ? 1.0 : 2.0) * values[i].real();
    }
    return cepstrum;
}

// From the same chapter: h[0] = exp(c[0]), and n h[n] is the sum of k c[k] h[n - k] over k from 1 to n.
ToneKernel toneKernel(const ToneCepstrum& cepstrum) noexcept {
    std::array<double, toneTaps> response{};
    response[0] = std::exp(cepstrum[0]);
    for (std::size_t n = 1; n < response.size(); ++n) {
        double sum = 0.0;
        for (std::size_t k = 1; k <= n; ++k) {
            sum += static_cast<double>(k) * cepstrum[k] * response[n - k];
        }
        response[n] = sum / static_cast<double>(n);
    }
    ToneKernel kernel{};
    for (std::size_t n = 0; n < kernel.size(); ++n) {
        kernel[n] = static_cast<float>(response[n]);
    }
    return kernel;
}

}  // namespace haptoflow::dsp
