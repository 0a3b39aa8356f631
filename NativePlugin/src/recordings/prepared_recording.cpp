#include "recordings/prepared_recording.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"
#include "recordings/dft321.hpp"

#include <algorithm>
#include <bit>
#include <complex>

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
        const auto allFinite = [](std::span<const float> values) {
            return std::ranges::all_of(values, [](float value) { return std::isfinite(value); });
        };
        const auto isFinite = [&](std::size_t i) {
            return allFinite(recording_.accelerationMps2.subspan(i * recording_.axisCount, recording_.axisCount)) &&
                   (recording_.velocityMps.empty() || allFinite(recording_.velocityMps.subspan(2 * i, 2))) &&
                   (recording_.forceNewtons.empty() || std::isfinite(recording_.forceNewtons[i]));
        };
        std::size_t first = 0;
        for (std::size_t i = 0; i <= samples_; ++i) {
            if (i == samples_ || isFinite(i)) {
                if (i > first) {
                    leaveOut(first, i - 1);
                }
                first = i + 1;
            }
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

}  // namespace haptoflow::recordings
