#include "learning/texture_figures.hpp"

#include "dsp/fourier_transform.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <numbers>

namespace haptoflow::learning {
namespace {

constexpr std::array<std::size_t, 3> pieceSamples{4, 20, 60};
constexpr double powerFloor = 1e-3;
constexpr double samplesPerBin = 2800.0;
constexpr double narrowestBin = 0.18;

const std::array<double, spectrumSamples>& hannWindow() {
    static const auto window = [] {
        std::array<double, spectrumSamples> values{};
        for (std::size_t i = 0; i < spectrumSamples; ++i) {
            values[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                             static_cast<double>(spectrumSamples));
        }
        return values;
    }();
    return window;
}

}  // namespace

std::size_t SpeedBins::binOf(double speedMps) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(edgesMps, speedMps) - edgesMps.begin());
}

SpeedBins SpeedBins::divide(std::vector<double> speedsMps, std::size_t most) {
    std::ranges::sort(speedsMps);
    const auto total = static_cast<double>(speedsMps.size());
    const auto bins = std::clamp<std::size_t>(static_cast<std::size_t>(total / samplesPerBin), 1, most);
    SpeedBins result;
    double last = speedsMps.front();
    for (std::size_t i = 1; i < bins; ++i) {
        const double edge =
            speedsMps[static_cast<std::size_t>(total * static_cast<double>(i) / static_cast<double>(bins))];
        if (std::log(edge / last) >= narrowestBin && std::log(speedsMps.back() / edge) >= narrowestBin) {
            result.edgesMps.push_back(edge);
            last = edge;
        }
    }
    std::vector<double> sums(result.edgesMps.size() + 1);
    std::vector<double> counts(sums.size());
    for (const double speed : speedsMps) {
        const std::size_t bin = result.binOf(speed);
        sums[bin] += std::log(speed);
        counts[bin] += 1.0;
    }
    for (std::size_t bin = 0; bin < sums.size(); ++bin) {
        result.centresMps.push_back(std::exp(sums[bin] / std::max(counts[bin], 1.0)));
    }
    return result;
}

std::array<double, spectrumBins> powerOf(std::span<const float, spectrumSamples> wave) {
    std::vector<std::complex<double>> values(spectrumSamples);
    for (std::size_t i = 0; i < spectrumSamples; ++i) {
        values[i] = static_cast<double>(wave[i]) * hannWindow()[i];
    }
    dsp::fourierTransform(values, dsp::Direction::forward);
    // Scales the sum of the bins to the mean square: the window's is 3/8, and inner bins represent two frequencies.
    constexpr double windowPower = 0.375;
    constexpr auto length = static_cast<double>(spectrumSamples);
    std::array<double, spectrumBins> power{};
    for (std::size_t bin = 0; bin < spectrumBins; ++bin) {
        const double sides = bin == 0 || bin + 1 == spectrumBins ? 1.0 : 2.0;
        power[bin] = sides * std::norm(values[bin]) / (windowPower * length * length);
    }
    return power;
}

TextureMeter::TextureMeter(std::size_t bins) : sums_(bins) {}

void TextureMeter::addLines(Sums& sums, std::span<const float, spectrumSamples> wave,
                            std::span<const RibTravel> ribTravels) const {
    constexpr double slowestHz = 15.0;
    constexpr double fastestHz = 900.0;
    constexpr double frameSeconds = static_cast<double>(spectrumSamples) / inference::waveformRateHz;
    // A Hann window sums to half of its samples.
    constexpr double windowSum = 0.5 * static_cast<double>(spectrumSamples);
    for (std::size_t rib = 0; rib < inference::ribCount; ++rib) {
        const double rateHz = std::abs(ribTravels.back()[rib] - ribTravels.front()[rib]) / frameSeconds;
        if (rateHz <= 0.0) {
            continue;
        }
        std::array<std::complex<double>, partialsOfRib> sum{};
        for (std::size_t i = 0; i < spectrumSamples; ++i) {
            const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * ribTravels[i][rib]);
            std::complex<double> each = hannWindow()[i] * static_cast<double>(wave[i]);
            for (std::complex<double>& partial : sum) {
                each *= turn;
                partial += each;
            }
        }
        for (std::size_t partial = 0; partial < partialsOfRib; ++partial) {
            const double hertz = rateHz * static_cast<double>(partial + 1);
            if (hertz >= slowestHz && hertz <= fastestHz) {
                sums.lines[rib * partialsOfRib + partial] += 2.0 * std::norm(sum[partial]) / (windowSum * windowSum);
                sums.lineFrames[rib * partialsOfRib + partial] += 1.0;
            }
        }
    }
}

void TextureMeter::add(std::size_t bin, std::span<const float, spectrumSamples> wave,
                       std::span<const RibTravel> ribTravels) {
    Sums& sums = sums_.at(bin);
    std::ranges::transform(sums.power, powerOf(wave), sums.power.begin(), std::plus{});
    if (!ribTravels.empty()) {
        addLines(sums, wave, ribTravels);
    }
    sums.frames += 1.0;
    double squares = 0.0;
    double fourths = 0.0;
    for (const float value : wave) {
        const double square = static_cast<double>(value) * value;
        squares += square;
        fourths += square * square;
    }
    sums.squares += squares;
    sums.fourths += fourths;
    sums.logKurtoses +=
        std::log((fourths * static_cast<double>(spectrumSamples) + powerFloor) / (squares * squares + powerFloor));
    sums.samples += static_cast<double>(spectrumSamples);
    for (std::size_t kind = 0; kind < pieceSamples.size(); ++kind) {
        const std::size_t length = pieceSamples[kind];
        for (std::size_t start = 0; start + length <= wave.size(); start += length) {
            double power = 0.0;
            for (std::size_t i = start; i < start + length; ++i) {
                power += static_cast<double>(wave[i]) * wave[i];
            }
            const double logRms = 0.5 * std::log(power / static_cast<double>(length) + powerFloor);
            sums.pieces[kind] += 1.0;
            sums.logs[kind] += logRms;
            sums.logSquares[kind] += logRms * logRms;
        }
    }
}

std::vector<TextureFigures> TextureMeter::figures() const {
    std::vector<TextureFigures> result(sums_.size());
    for (std::size_t bin = 0; bin < sums_.size(); ++bin) {
        const Sums& sums = sums_[bin];
        TextureFigures& each = result[bin];
        each.frames = sums.frames;
        if (sums.frames <= 0.0) {
            continue;
        }
        for (std::size_t i = 0; i < spectrumBins; ++i) {
            each.power[i] = sums.power[i] / sums.frames;
        }
        each.meanSquare = sums.squares / sums.samples;
        const double logRms = 0.5 * std::log(each.meanSquare + powerFloor);
        for (std::size_t kind = 0; kind < pieceSamples.size(); ++kind) {
            const double mean = sums.logs[kind] / sums.pieces[kind];
            const double variance = sums.logSquares[kind] / sums.pieces[kind] - mean * mean;
            each.envelope[2 * kind] = mean - logRms;
            each.envelope[2 * kind + 1] = std::sqrt(std::max(variance, 0.0));
        }
        each.logKurtosis = sums.logKurtoses / sums.frames;
        each.lineFrames = sums.lineFrames;
        for (std::size_t i = 0; i < ribPartials; ++i) {
            each.lines[i] = sums.lines[i] / std::max(sums.lineFrames[i], 1.0);
        }
        const double kurtosis = sums.fourths / sums.samples / (each.meanSquare * each.meanSquare + 1e-12);
        each.envelope[envelopeFigures - 1] = 0.25 * std::log(kurtosis + 1e-3);
    }
    return result;
}

}  // namespace haptoflow::learning
