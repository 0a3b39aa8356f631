#include "learning/frequency_exponent.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace haptoflow::learning {

double frequencyExponent(const SpeedBins& bins, std::span<const TextureFigures> recorded, const model::Label& start) {
    constexpr double priorSpread = 0.1;
    constexpr double centroidSpread = 0.08;
    const double prior = start.wavelengthMetres ? 0.1 : start.frequencyExponent;
    std::vector<double> x;
    std::vector<double> y;
    for (std::size_t bin = 0; bin < bins.count(); ++bin) {
        double power = 0.0;
        double logs = 0.0;
        for (std::size_t i = 3; i < spectrumBins / 2; ++i) {
            power += recorded[bin].power[i];
            logs += recorded[bin].power[i] * std::log(static_cast<double>(i));
        }
        if (power > 0.0) {
            x.push_back(std::log(bins.centresMps[bin]));
            y.push_back(logs / power);
        }
    }
    const auto count = static_cast<double>(std::max<std::size_t>(x.size(), 1));
    const double meanX = std::accumulate(x.begin(), x.end(), 0.0) / count;
    const double meanY = std::accumulate(y.begin(), y.end(), 0.0) / count;
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        squares += (x[i] - meanX) * (x[i] - meanX);
        products += (x[i] - meanX) * (y[i] - meanY);
    }
    const double trust = squares / (centroidSpread * centroidSpread);
    const double priorTrust = 1.0 / (priorSpread * priorSpread);
    const double slope = squares > 0.0 ? products / squares : prior;
    return std::clamp((trust * slope + priorTrust * prior) / (trust + priorTrust), 0.0, 1.0);
}

}  // namespace haptoflow::learning
