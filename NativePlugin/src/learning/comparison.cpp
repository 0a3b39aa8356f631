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

}  // namespace

std::vector<double> comparedHz() {
    std::vector<double> hertz;
    for (double each = lowestHz; each < highestHz; each *= step) {
        hertz.push_back(each);
    }
    return hertz;
}

std::vector<SpeedComparison::Curve> curvesOf(const SpeedBins& bins, std::span<const SpectrumFrame> frames,
                                             const model::ToneTable* tone,
                                             const std::function<double(const SpectrumFrame&)>& powerOf) {
    std::vector<SpeedComparison::Curve> curves;
    for (const MeanSpectrum& mean : meanSpectra(bins, frames, tone, powerOf)) {
        SpeedComparison::Curve curve;
        if (mean.frames > 0.0) {
            for (const double hertz : comparedHz()) {
                curve.decibels.push_back(densityDb(mean, hertz));
            }
            curve.rmsMps2 = std::sqrt(mean.whole());
        }
        curves.push_back(std::move(curve));
    }
    return curves;
}

}  // namespace haptoflow::learning
