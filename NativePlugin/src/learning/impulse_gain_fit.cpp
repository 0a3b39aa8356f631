#include "learning/impulse_gain_fit.hpp"

#include <algorithm>
#include <array>
#include <vector>

namespace haptoflow::learning {
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
