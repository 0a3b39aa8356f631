#include "recordings/prepared_recording.hpp"

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

constexpr double flatShare = 0.95;
// Resampler and high-pass filter ring for this long around missing samples.
constexpr double neighbourhoodSeconds = 0.06;
constexpr double frozenSeconds = 0.03;
constexpr double motionWindowSeconds = 0.02;

Channel channelOf(const Recording& recording, std::size_t axis, std::size_t samples) {
    Channel channel{.first = recording.accelerationMps2.data() + axis,
                    .stride = recording.axisCount,
                    .count = samples,
                    .mean = 0.0};
    double sum = 0.0;
    std::size_t finite = 0;
    for (std::size_t i = 0; i < samples; ++i) {
        const double value = channel.first[i * channel.stride];
        if (std::isfinite(value)) {
            sum += value;
            ++finite;
        }
    }
    channel.mean = finite > 0 ? sum / static_cast<double>(finite) : 0.0;
    return channel;
}

std::size_t preparedSamples(const Recording& recording) {
    return std::min(recording.sampleCount(), static_cast<std::size_t>(maximumSeconds * recording.rateHz));
}

class Neighbourhoods {
public:
    Neighbourhoods(const Recording& recording, std::size_t samples, std::size_t prepared)
        : recording_(recording), samples_(samples), isUsable_(prepared, 1) {}

    std::vector<std::uint8_t> usable() {
        leaveOutNonFinite();
        leaveOutFrozen();
        return std::move(isUsable_);
    }

private:
    /// Excludes the samples from first to last and their surroundings.
    void leaveOut(std::size_t first, std::size_t last) {
        const double startSeconds = static_cast<double>(first) / recording_.rateHz - neighbourhoodSeconds;
        const double endSeconds = static_cast<double>(last) / recording_.rateHz + neighbourhoodSeconds;
        const auto begin = static_cast<std::size_t>(std::max(0.0, std::floor(startSeconds * dsp::waveformRateHz)));
        const auto end = static_cast<std::size_t>(std::ceil(endSeconds * dsp::waveformRateHz));
        for (std::size_t i = begin; i < std::min(end, isUsable_.size()); ++i) {
            isUsable_[i] = 0;
        }
    }

    void leaveOutNonFinite() {
        std::size_t after = 0;
        bool isOpen = false;
        std::size_t first = 0;
        const auto allFinite = [](std::span<const float> values) {
            return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
        };
        for (std::size_t i = 0; i < samples_; ++i) {
            const bool isFinite =
                allFinite(recording_.accelerationMps2.subspan(i * recording_.axisCount, recording_.axisCount)) &&
                (recording_.velocityMps.empty() || allFinite(recording_.velocityMps.subspan(2 * i, 2))) &&
                (recording_.forceNewtons.empty() || std::isfinite(recording_.forceNewtons[i]));
            if (!isFinite && !isOpen) {
                isOpen = true;
                first = i;
            } else if (isFinite && isOpen) {
                isOpen = false;
                leaveOut(first, i - 1);
            }
            after = i;
        }
        if (isOpen) {
            leaveOut(first, after);
        }
    }

    void leaveOutFrozen() {
        const auto longest = static_cast<std::size_t>(frozenSeconds * recording_.rateHz);
        const auto sample = [&](std::size_t i) {
            return recording_.accelerationMps2.subspan(i * recording_.axisCount, recording_.axisCount);
        };
        std::size_t first = 0;
        for (std::size_t i = 1; i <= samples_; ++i) {
            if (i == samples_ || !std::ranges::equal(sample(i), sample(first))) {
                if (i - first > longest) {
                    leaveOut(first, i - 1);
                }
                first = i;
            }
        }
    }

    const Recording& recording_;
    std::size_t samples_;
    std::vector<std::uint8_t> isUsable_;
};

/// Means of a window around each sample at 2 kHz, without values that are not finite; if none are left, the previous
/// mean is repeated.
std::vector<float> windowMeans(const float* values, std::size_t stride, std::size_t samples, double rateHz,
                               std::size_t prepared) {
    std::vector<float> means(prepared);
    float last = 0.0F;
    for (std::size_t n = 0; n < prepared; ++n) {
        const double centre = static_cast<double>(n) / dsp::waveformRateHz * rateHz;
        const double half = 0.5 * motionWindowSeconds * rateHz;
        const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(centre - half)));
        const std::size_t end = std::min(samples, static_cast<std::size_t>(std::floor(centre + half)) + 1);
        double sum = 0.0;
        std::size_t count = 0;
        for (std::size_t i = first; i < end; ++i) {
            const float value = values[i * stride];
            if (std::isfinite(value)) {
                sum += value;
                ++count;
            }
        }
        last = count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : last;
        means[n] = last;
    }
    return means;
}

}  // namespace

double PreparedRecording::speedMps(std::size_t sample) const {
    return std::hypot(static_cast<double>(motion[sample][0]), static_cast<double>(motion[sample][1]));
}

std::vector<float> combinedWave(const Recording& recording) {
    std::array<std::vector<double>, 3> axes;
    for (std::size_t axis = 0; axis < recording.axisCount; ++axis) {
        const Channel channel = channelOf(recording, axis, preparedSamples(recording));
        axes[axis] = bandPassed(resampled(channel, recording.rateHz, dsp::waveformRateHz));
    }
    const std::vector<double> wave = recording.axisCount == 3 ? combineAxes(axes) : std::move(axes[0]);
    return {wave.begin(), wave.end()};
}

PreparedRecording prepareRecording(const Recording& recording) {
    const std::size_t samples = preparedSamples(recording);
    PreparedRecording prepared;
    prepared.wave = combinedWave(recording);
    const std::size_t count = prepared.wave.size();
    prepared.isUsable = Neighbourhoods(recording, samples, count).usable();
    prepared.bandwidthHz = 0.5 * flatShare * std::min(recording.rateHz, dsp::waveformRateHz);
    prepared.motion.resize(count);
    const auto fill = [&](std::size_t component, std::span<const float> values, std::size_t stride, std::size_t offset,
                          double constant) {
        const std::vector<float> means =
            values.empty() ? std::vector<float>(count, static_cast<float>(constant))
                           : windowMeans(values.data() + offset, stride, samples, recording.rateHz, count);
        for (std::size_t i = 0; i < count; ++i) {
            prepared.motion[i][component] = means[i];
        }
    };
    fill(0, recording.velocityMps, 2, 0, recording.constantVelocityMps[0]);
    fill(1, recording.velocityMps, 2, 1, recording.constantVelocityMps[1]);
    fill(2, recording.forceNewtons, 1, 0, recording.constantForceNewtons);
    const bool showsRest = !recording.velocityMps.empty();
    if (showsRest) {
        prepared.noise = removeSensorNoise(prepared.wave, prepared.motion, prepared.isUsable);
    }
    return prepared;
}

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

/// A discrete Fourier transform of a length that is not a power of two, computed by its definition: frames are few and
/// short.
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
            // If the axes cancel exactly, their sum has no phase; the phase of the strongest one is used.
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
