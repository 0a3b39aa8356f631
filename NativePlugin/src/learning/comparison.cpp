#include "learning/comparison.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

constexpr double lowestHz = 2.0 * hertzPerBin;
constexpr double highestHz = 900.0;
constexpr double step = 1.122462048309373;  // a sixth of an octave
constexpr double floorDb = -140.0;

/// Mean density over the bins within half a step, at least the nearest one.
double densityDb(const MeanSpectrum& mean, double hertz) {
    const auto nearest = static_cast<std::size_t>(std::lround(hertz / hertzPerBin));
    const auto first = std::min(nearest, static_cast<std::size_t>(std::ceil(hertz / std::sqrt(step) / hertzPerBin)));
    const auto last = std::max(nearest, static_cast<std::size_t>(hertz * std::sqrt(step) / hertzPerBin));
    double power = 0.0;
    for (std::size_t bin = first; bin <= last; ++bin) {
        power += mean.power[bin];
    }
    const double density = power / (static_cast<double>(last - first + 1) * hertzPerBin);
    return density > 0.0 ? std::max(10.0 * std::log10(density), floorDb) : floorDb;
}

/// Empty without frames.
SpeedComparison::Curve curveOf(const MeanSpectrum& mean) {
    SpeedComparison::Curve curve;
    if (mean.frames > 0.0) {
        for (const double hertz : comparedHz()) {
            curve.decibels.push_back(densityDb(mean, hertz));
        }
        curve.rmsMps2 = std::sqrt(mean.whole());
    }
    return curve;
}

}  // namespace

std::vector<double> comparedHz() {
    std::vector<double> hertz;
    double each = lowestHz;
    while (each < highestHz) {
        hertz.push_back(each);
        each *= step;
    }
    return hertz;
}

std::vector<SpeedComparison> compared(const SpeedBins& bins, const ComparedFrames& recorded,
                                      const ComparedFrames& learnt, const ComparedFrames& nearestLabel) {
    constexpr double secondsPerFrame = 0.5 * spectrumSamples / inference::waveformRateHz;
    std::vector<SpeedComparison> comparisons(bins.count());
    const auto add = [&](const ComparedFrames& shown, SpeedComparison::Curve SpeedComparison::*curve) {
        std::vector<MeanSpectrum> means = meanSpectra(bins, shown.frames, shown.levels, shown.tone);
        for (std::size_t bin = 0; bin < means.size(); ++bin) {
            comparisons[bin].*curve = curveOf(means[bin]);
            (comparisons[bin].*curve).figures = figuresOf(shown.moments, shown.levels, [&](std::size_t frame) {
                return bins.binOf(shown.frames[frame].speedMps) == bin;
            });
        }
        return means;
    };
    add(learnt, &SpeedComparison::learnt);
    add(nearestLabel, &SpeedComparison::nearestLabel);
    const std::vector<MeanSpectrum> means = add(recorded, &SpeedComparison::recorded);
    for (std::size_t bin = 0; bin < means.size(); ++bin) {
        comparisons[bin].speedMps = bins.centresMps[bin];
        comparisons[bin].seconds = means[bin].frames * secondsPerFrame;
    }
    return comparisons;
}

}  // namespace haptoflow::learning
