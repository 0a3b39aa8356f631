#include "learning/tone_fit.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

constexpr double lowestHz = 20.0;
constexpr double highestHz = 950.0;
constexpr double bandOctaves = 1.0 / 3.0;
constexpr double narrowestHz = 7.0;
constexpr double relativeWidth = 0.12;
constexpr double maximumGainDb = 24.0;
/// Decibels per unit of the natural logarithm of a power.
constexpr double decibels = 4.342944819032518;
/// Number of overlapping frames with the information of one independent frame.
constexpr double framesPerIndependent = 2.2;
constexpr double commonSpreadDb = 10.0;
constexpr double minimumFrames = 3.0;

std::vector<double> bandCentres(double bandwidthHz) {
    std::vector<double> centres;
    const double last = std::min(highestHz, bandwidthHz);
    for (double centre = lowestHz; centre < 0.9 * last; centre *= std::exp2(bandOctaves)) {
        centres.push_back(centre);
    }
    centres.push_back(last);
    return centres;
}

struct Ratio {
    double decibel = 0.0;
    double variance = 0.0;
};

/// Ratio of recorded to generated power around a frequency.
Ratio ratioAt(const TextureFigures& recorded, const TextureFigures& generated, double centreHz) {
    const double width = std::max(narrowestHz, relativeWidth * centreHz);
    double wanted = 0.0;
    double found = 0.0;
    double weights = 0.0;
    double squares = 0.0;
    for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
        const double distance = (static_cast<double>(bin) * hertzPerBin - centreHz) / width;
        if (std::abs(distance) > 3.0) {
            continue;
        }
        const double weight = std::exp(-0.5 * distance * distance);
        wanted += weight * recorded.power[bin];
        found += weight * generated.power[bin];
        weights += weight;
        squares += weight * weight;
    }
    // Neighbouring bins of a Hann window are not independent.
    const double bands = std::max(1.0, weights * weights / squares / 1.5);
    const double independent = 1.0 / recorded.frames + 1.0 / generated.frames;
    return {.decibel = decibels * std::log((wanted + 1e-9 * weights) / (found + 1e-9 * weights)),
            .variance = decibels * decibels * framesPerIndependent * independent / bands};
}

/// Shrinks one frequency's ratios at several speeds towards their mean.
std::vector<double> shrunk(const std::vector<Ratio>& ratios) {
    double weights = 0.0;
    double mean = 0.0;
    for (const Ratio& ratio : ratios) {
        weights += 1.0 / (ratio.variance + 1.0);
        mean += ratio.decibel / (ratio.variance + 1.0);
    }
    mean /= weights;
    double excess = 0.0;
    for (const Ratio& ratio : ratios) {
        const double away = ratio.decibel - mean;
        excess += (away * away - ratio.variance) / static_cast<double>(ratios.size());
    }
    // The lower limit keeps rows from becoming identical, which as few as three numbers cannot justify.
    const double spread = std::clamp(excess, 0.5, 100.0);
    double meanVariance = 0.0;
    for (const Ratio& ratio : ratios) {
        meanVariance += ratio.variance / static_cast<double>(ratios.size() * ratios.size());
    }
    const double kept = commonSpreadDb * commonSpreadDb / (commonSpreadDb * commonSpreadDb + meanVariance);
    std::vector<double> result;
    for (const Ratio& ratio : ratios) {
        const double share = spread / (spread + ratio.variance);
        result.push_back(kept * mean + share * (ratio.decibel - mean));
    }
    return result;
}

double powerBehind(const TextureFigures& figures, const model::ToneTable& tone, std::size_t row) {
    double sum = 0.0;
    for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
        const double gain = tone.rowGainDb(row, static_cast<double>(bin) * hertzPerBin);
        sum += figures.power[bin] * std::pow(10.0, 0.1 * gain);
    }
    return sum;
}

}  // namespace

ToneFit fitTone(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                std::span<const TextureFigures> generated, double bandwidthHz) {
    ToneFit fit;
    std::vector<std::size_t> used;
    for (std::size_t bin = 0; bin < bins.count(); ++bin) {
        if (recorded[bin].frames >= minimumFrames && generated[bin].frames >= minimumFrames) {
            used.push_back(bin);
            fit.tone.speedsMps.push_back(bins.centresMps[bin]);
        }
    }
    if (used.empty()) {
        return fit;
    }
    fit.tone.frequenciesHz = bandCentres(bandwidthHz);
    fit.tone.gainsDb.assign(used.size(), std::vector<double>(fit.tone.frequenciesHz.size()));
    for (std::size_t f = 0; f < fit.tone.frequenciesHz.size(); ++f) {
        std::vector<Ratio> ratios;
        for (const std::size_t bin : used) {
            ratios.push_back(ratioAt(recorded[bin], generated[bin], fit.tone.frequenciesHz[f]));
        }
        const std::vector<double> gains = shrunk(ratios);
        for (std::size_t row = 0; row < used.size(); ++row) {
            fit.tone.gainsDb[row][f] = std::clamp(gains[row], -maximumGainDb, maximumGainDb);
        }
    }
    for (std::size_t row = 0; row < used.size(); ++row) {
        const TextureFigures& made = generated[used[row]];
        double before = 0.0;
        for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
            before += made.power[bin];
        }
        const double common = 10.0 * std::log10(powerBehind(made, fit.tone, row) / std::max(before, 1e-12));
        for (double& gain : fit.tone.gainsDb[row]) {
            gain = std::clamp(gain - common, -30.0, 30.0);
        }
        const double after = powerBehind(made, fit.tone, row);
        fit.logLevels.push_back(-0.5 * std::log(std::max(after, 1e-9)));
    }
    return fit;
}

double ToneFit::logLevel(double speedMps) const {
    const std::vector<double>& speeds = tone.speedsMps;
    if (speedMps <= speeds.front()) {
        return logLevels.front();
    }
    if (speedMps >= speeds.back()) {
        return logLevels.back();
    }
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(speeds, speedMps) - speeds.begin());
    const double share = std::log(speedMps / speeds[above - 1]) / std::log(speeds[above] / speeds[above - 1]);
    return logLevels[above - 1] + share * (logLevels[above] - logLevels[above - 1]);
}

double spectralDistanceDb(const SpeedBins& bins, std::span<const TextureFigures> recorded,
                          std::span<const TextureFigures> generated, const ToneFit& fit) {
    constexpr double lowestComparedHz = 20.0;
    constexpr double highestComparedHz = 450.0;
    double total = 0.0;
    double weights = 0.0;
    for (std::size_t bin = 0; bin < bins.count(); ++bin) {
        if (recorded[bin].frames <= 0.0 || generated[bin].frames <= 0.0) {
            continue;
        }
        const double speed = bins.centresMps[bin];
        const double gainDb = decibelsPerNat * fit.logLevel(speed);
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t i = 1; i < spectrumBins; ++i) {
            const double hertz = static_cast<double>(i) * hertzPerBin;
            if (hertz >= lowestComparedHz && hertz <= highestComparedHz) {
                const double made =
                    10.0 * std::log10(generated[bin].power[i] + 1e-12) + fit.tone.gainDb(speed, hertz) + gainDb;
                const double difference = made - 10.0 * std::log10(recorded[bin].power[i] + 1e-12);
                squares += difference * difference;
                count += 1.0;
            }
        }
        total += recorded[bin].frames * std::sqrt(squares / count);
        weights += recorded[bin].frames;
    }
    return weights > 0.0 ? total / weights : 0.0;
}

}  // namespace haptoflow::learning
