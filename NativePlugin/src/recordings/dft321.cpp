#include "recordings/dft321.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace haptoflow::recordings {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t hop = 35;
constexpr std::size_t frameSamples = 2 * hop;
constexpr std::size_t frameBins = hop + 1;
constexpr int correctionRounds = 3;
constexpr double maximumCorrection = 1.9952623149688795;  // 6 dB
constexpr double lowestCentreHz = 12.401570718501561;     // third octaves from 1 kHz down
constexpr std::size_t restoredTailSamples = 400;

using FrameSpectrum = std::array<Complex, frameBins>;

/// Discrete Fourier transform of a windowed frame and its inverse. Computed by its definition, since frames are few and
/// 70 samples long.
class FrameTransform {
public:
    FrameTransform() {
        for (std::size_t i = 0; i < frameSamples; ++i) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(frameSamples);
            turns_[i] = std::polar(1.0, -angle);
            window_[i] = std::sin(0.5 * angle);
        }
    }

    [[nodiscard]] FrameSpectrum forward(const double* samples) const {
        FrameSpectrum spectrum{};
        for (std::size_t bin = 0; bin < frameBins; ++bin) {
            for (std::size_t i = 0; i < frameSamples; ++i) {
                spectrum[bin] += samples[i] * window_[i] * turns_[bin * i % frameSamples];
            }
        }
        return spectrum;
    }

    void addInverse(const FrameSpectrum& spectrum, double* samples) const {
        for (std::size_t i = 0; i < frameSamples; ++i) {
            double sum = spectrum[0].real();
            for (std::size_t bin = 1; bin < frameBins; ++bin) {
                const double share = bin + 1 == frameBins ? 1.0 : 2.0;
                sum += share * (spectrum[bin] * std::conj(turns_[bin * i % frameSamples])).real();
            }
            samples[i] += sum / static_cast<double>(frameSamples) * window_[i];
        }
    }

private:
    std::array<Complex, frameSamples> turns_{};
    std::array<double, frameSamples> window_{};
};

FrameSpectrum combined(const std::array<FrameSpectrum, 3>& axes) {
    FrameSpectrum result;
    for (std::size_t bin = 0; bin < frameBins; ++bin) {
        const double magnitude = std::sqrt(std::norm(axes[0][bin]) + std::norm(axes[1][bin]) + std::norm(axes[2][bin]));
        Complex direction = axes[0][bin] + axes[1][bin] + axes[2][bin];
        if (std::abs(direction) <= 1e-9 * magnitude) {
            // Where the axes cancel, their sum is zero and has no phase, so the strongest axis gives the phase.
            direction = std::max({axes[0][bin], axes[1][bin], axes[2][bin]},
                                 [](Complex one, Complex other) { return std::norm(one) < std::norm(other); });
        }
        const double length = std::abs(direction);
        result[bin] = length > 0.0 ? direction * (magnitude / length) : Complex(0.0);
    }
    return result;
}

std::vector<Complex> transformOf(const std::vector<double>& values, std::size_t size) {
    std::vector<Complex> spectrum(size);
    std::ranges::copy(values, spectrum.begin());
    dsp::fourierTransform(spectrum, dsp::Direction::forward);
    return spectrum;
}

struct Band {
    double logCentre = 0.0;
    std::size_t first = 0;
    std::size_t end = 0;
};

std::vector<Band> thirdOctaves(std::size_t size) {
    const double hertzPerBin = dsp::waveformRateHz / static_cast<double>(size);
    const double halfBand = std::pow(2.0, 1.0 / 6.0);
    std::vector<Band> bands;
    for (double centre = lowestCentreHz; centre * halfBand < dsp::waveformRateHz / 2.0; centre *= halfBand * halfBand) {
        const Band band{.logCentre = std::log(centre),
                        .first = static_cast<std::size_t>(std::ceil(centre / halfBand / hertzPerBin)),
                        .end = static_cast<std::size_t>(std::ceil(centre * halfBand / hertzPerBin))};
        if (band.end > band.first) {
            bands.push_back(band);
        }
    }
    return bands;
}

double interpolated(const std::vector<Band>& bands, const std::vector<double>& logGains, double logHertz) {
    if (logHertz <= bands.front().logCentre) {
        return logGains.front();
    }
    for (std::size_t i = 1; i < bands.size(); ++i) {
        if (logHertz < bands[i].logCentre) {
            const double share = (logHertz - bands[i - 1].logCentre) / (bands[i].logCentre - bands[i - 1].logCentre);
            return logGains[i - 1] + share * (logGains[i] - logGains[i - 1]);
        }
    }
    return logGains.back();
}

std::vector<double> withBandEnergies(std::vector<double> wave, const std::array<std::vector<double>, 3>& axes) {
    const std::size_t size = std::bit_ceil(wave.size() + restoredTailSamples);
    std::vector<Complex> spectrum = transformOf(wave, size);
    std::vector<double> wanted(size / 2 + 1);
    for (const std::vector<double>& axis : axes) {
        const std::vector<Complex> each = transformOf(axis, size);
        for (std::size_t bin = 0; bin < wanted.size(); ++bin) {
            wanted[bin] += std::norm(each[bin]);
        }
    }
    const std::vector<Band> bands = thirdOctaves(size);
    const double loudest = *std::max_element(wanted.begin(), wanted.end());
    std::vector<double> logGains(bands.size());
    std::vector<double> gain(wanted.size(), 1.0);
    for (int round = 0; round < correctionRounds; ++round) {
        for (std::size_t band = 0; band < bands.size(); ++band) {
            double found = 0.0;
            double target = 0.0;
            for (std::size_t bin = bands[band].first; bin < bands[band].end; ++bin) {
                found += std::norm(spectrum[bin]) * gain[bin] * gain[bin];
                target += wanted[bin];
            }
            if (found > 1e-20 * std::max(loudest, 1e-300) && target > 0.0) {
                const double limit = std::log(maximumCorrection);
                logGains[band] = std::clamp(logGains[band] + 0.5 * std::log(target / found), -limit, limit);
            }
        }
        for (std::size_t bin = 0; bin < gain.size(); ++bin) {
            const double hertz =
                std::max(static_cast<double>(bin) * dsp::waveformRateHz / static_cast<double>(size), 1.0);
            gain[bin] = std::exp(interpolated(bands, logGains, std::log(hertz)));
        }
    }
    for (std::size_t bin = 0; bin < gain.size(); ++bin) {
        spectrum[bin] *= gain[bin];
        if (bin != 0 && bin != size - bin) {
            spectrum[size - bin] *= gain[bin];
        }
    }
    dsp::fourierTransform(spectrum, dsp::Direction::inverse);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        wave[i] = spectrum[i].real();
    }
    return wave;
}

}  // namespace

std::vector<double> combineAxes(const std::array<std::vector<double>, 3>& axes) {
    const FrameTransform transform;
    const std::size_t count = axes[0].size();
    const std::size_t frames = (count + hop - 1) / hop + 1;
    std::array<std::vector<double>, 3> padded;
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
        padded[axis].resize((frames + 1) * hop);
        std::copy_n(axes[axis].begin(), count, padded[axis].begin() + hop);
    }
    std::vector<double> sum((frames + 1) * hop);
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const std::size_t start = frame * hop;
        transform.addInverse(
            combined({transform.forward(padded[0].data() + start), transform.forward(padded[1].data() + start),
                      transform.forward(padded[2].data() + start)}),
            sum.data() + start);
    }
    return withBandEnergies({sum.begin() + hop, sum.begin() + hop + static_cast<std::ptrdiff_t>(count)}, axes);
}

}  // namespace haptoflow::recordings
