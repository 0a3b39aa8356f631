#include "learning/frequency_exponent.hpp"

#include <algorithm>
#include <array>
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

namespace {

constexpr std::array<float, 7> factors{0.0F, 0.5F, 1.0F, 1.5F, 2.0F, 3.0F, 4.0F};

double kurtosisDistance(const TextureFigures& recorded, const TextureFigures& generated) {
    const double difference = generated.logKurtosis - recorded.logKurtosis;
    return difference * difference;
}

}  // namespace

float fitImpulseGain(TextureFit& fit, const Embedding& embedding, const std::function<void(double)>& progress) {
    std::vector<double> distances;
    for (const float factor : factors) {
        progress(static_cast<double>(distances.size()) / static_cast<double>(factors.size()));
        distances.push_back(meanOverSpeeds(fit.recorded(), fit.figuresOf(embedding, factor), kurtosisDistance));
    }
    return factors[static_cast<std::size_t>(std::ranges::min_element(distances) - distances.begin())];
}

}  // namespace haptoflow::learning
