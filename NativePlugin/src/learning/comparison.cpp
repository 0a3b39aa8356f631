#include "learning/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

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

namespace {

constexpr std::size_t mostRanges = 3;
/// Three seconds.
constexpr double fewestFrames = 45.0;
/// Forces closer together are one force to a hand.
constexpr double smallestRatio = 1.4;
constexpr std::size_t lawSpeeds = 25;
constexpr double slowestMps = 0.005;
constexpr double fastestMps = 1.0;

/// The value that this share of the rising values does not exceed.
double quantileOf(std::span<const double> rising, double share) {
    return rising[static_cast<std::size_t>(std::lround(share * static_cast<double>(rising.size() - 1)))];
}

/// Divides the forces between their 5th and 95th percentile into ranges of equal ratio. Empty if one of them has too
/// few frames or is too near to the next.
std::optional<ForceRanges> divided(std::span<const double> rising, std::size_t count) {
    const double lightest = quantileOf(rising, 0.05);
    const double firmest = quantileOf(rising, 0.95);
    ForceRanges ranges;
    for (std::size_t edge = 1; edge < count; ++edge) {
        ranges.edgesNewtons.push_back(
            lightest * std::pow(firmest / lightest, static_cast<double>(edge) / static_cast<double>(count)));
    }
    std::vector<double> sums(count);
    std::vector<double> frames(count);
    for (const double force : rising) {
        const std::size_t range = ranges.rangeOf(force);
        sums[range] += std::log(force);
        frames[range] += 1.0;
    }
    for (std::size_t range = 0; range < count; ++range) {
        ranges.meansNewtons.push_back(std::exp(sums[range] / std::max(frames[range], 1.0)));
    }
    const auto isNear = [](double lighter, double firmer) { return firmer < smallestRatio * lighter; };
    const bool isClear = std::ranges::min(frames) >= fewestFrames &&
                         std::ranges::adjacent_find(ranges.meansNewtons, isNear) == ranges.meansNewtons.end();
    return count == 1 || isClear ? std::optional(ranges) : std::nullopt;
}

std::array<double, 2> middleOf(std::vector<double> speeds) {
    if (speeds.empty()) {
        return {};
    }
    std::ranges::sort(speeds);
    return {quantileOf(speeds, 0.02), quantileOf(speeds, 0.98)};
}

}  // namespace

std::size_t ForceRanges::rangeOf(double forceNewtons) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(edgesNewtons, forceNewtons) - edgesNewtons.begin());
}

ForceRanges ForceRanges::divide(std::span<const SpectrumFrame> recorded) {
    std::vector<double> forces;
    for (const SpectrumFrame& frame : recorded) {
        forces.push_back(std::max(frame.forceNewtons, model::LevelTable::minimumForceNewtons));
    }
    if (forces.empty()) {
        return {};
    }
    std::ranges::sort(forces);
    std::optional<ForceRanges> ranges;
    for (std::size_t count = mostRanges; !ranges; --count) {
        ranges = divided(forces, count);
    }
    return *ranges;
}

std::vector<double> lawSpeedsMps() {
    std::vector<double> speeds(lawSpeeds);
    for (std::size_t i = 0; i < speeds.size(); ++i) {
        speeds[i] =
            slowestMps * std::pow(fastestMps / slowestMps, static_cast<double>(i) / static_cast<double>(lawSpeeds - 1));
    }
    return speeds;
}

std::vector<ForceComparison> comparedByForce(const SpeedBins& bins, const ForceRanges& ranges,
                                             const ComparedFrames& recorded, const ComparedFrames& learnt,
                                             const ComparedFrames& nearestLabel) {
    std::vector<ForceComparison> comparisons(ranges.meansNewtons.size());
    for (std::size_t range = 0; range < comparisons.size(); ++range) {
        ForceComparison& comparison = comparisons[range];
        comparison.forceNewtons = ranges.meansNewtons[range];
        std::vector<double> speeds;
        for (const SpectrumFrame& frame : recorded.frames) {
            if (ranges.rangeOf(frame.forceNewtons) == range) {
                speeds.push_back(frame.speedMps);
            }
        }
        comparison.recordedMps = middleOf(std::move(speeds));
        for (std::size_t bin = 0; bin < bins.count(); ++bin) {
            const auto figures = [&](const ComparedFrames& shown) {
                return figuresOf(shown.moments, shown.levels, [&](std::size_t index) {
                    const SpectrumFrame& frame = shown.frames[index];
                    return bins.binOf(frame.speedMps) == bin && ranges.rangeOf(frame.forceNewtons) == range;
                });
            };
            const WaveFigures here = figures(recorded);
            if (here.frames > 0) {
                comparison.speeds.push_back({.speedMps = bins.centresMps[bin],
                                             .recorded = here,
                                             .learnt = figures(learnt),
                                             .nearestLabel = figures(nearestLabel)});
            }
        }
    }
    return comparisons;
}

ToneLevel::ToneLevel(const SpeedBins& bins, std::span<const SpectrumFrame> generated, const model::ToneTable& tone)
    : tone_(&tone) {
    const std::vector<MeanSpectrum> means = meanSpectra(bins, generated, {}, nullptr);
    for (std::size_t bin = 0; bin < means.size(); ++bin) {
        if (means[bin].frames > 0.0) {
            speedsMps_.push_back(bins.centresMps[bin]);
            spectra_.push_back(means[bin]);
        }
    }
}

double ToneLevel::at(double speedMps, double forceNewtons) const {
    if (spectra_.empty()) {
        return 1.0;
    }
    const auto gains = tone_.powerGains(speedMps, forceNewtons);
    const model::LogPlace place = model::placeInLog(speedsMps_, speedMps);
    const MeanSpectrum& slower = spectra_[place.lower];
    const MeanSpectrum& faster = spectra_[std::min(place.lower + 1, spectra_.size() - 1)];
    double power = 0.0;
    for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
        power += gains[bin] * std::lerp(slower.power[bin], faster.power[bin], place.share);
    }
    return std::sqrt(power);
}

}  // namespace haptoflow::learning
