#include "learning/impulse_gain_fit.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace haptoflow::learning {
namespace {

constexpr std::array<float, 7> factors{0.0F, 0.5F, 1.0F, 1.5F, 2.0F, 3.0F, 4.0F};

/// Mean squared difference of the log kurtosis over the speeds, weighted by the recording's frames.
double kurtosisDistance(std::span<const TextureFigures> recorded, std::span<const TextureFigures> generated) {
    double sum = 0.0;
    double weights = 0.0;
    for (std::size_t bin = 0; bin < recorded.size(); ++bin) {
        if (recorded[bin].frames > 0.0 && generated[bin].frames > 0.0) {
            const double difference = generated[bin].logKurtosis - recorded[bin].logKurtosis;
            sum += recorded[bin].frames * difference * difference;
            weights += recorded[bin].frames;
        }
    }
    return weights > 0.0 ? sum / weights : 0.0;
}

}  // namespace

float fitImpulseGain(TextureFit& fit, const Embedding& embedding, const std::function<void(double)>& progress) {
    std::vector<double> distances;
    for (const float factor : factors) {
        progress(static_cast<double>(distances.size()) / static_cast<double>(factors.size()));
        distances.push_back(kurtosisDistance(fit.recorded(), fit.figuresOf(embedding, factor)));
    }
    return factors[static_cast<std::size_t>(std::ranges::min_element(distances) - distances.begin())];
}

}  // namespace haptoflow::learning
