#include "headless/tracker_noise.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

constexpr double leastMetres = 5e-6;
constexpr double mostMetres = 500e-6;
constexpr double quantile = 0.35;
// That quantile of the length of three standard normal numbers.
constexpr double quantileLength = 1.2812;
constexpr double step = 0.1;

}  // namespace

void TrackerNoise::add(double timeSeconds, const glm::dvec3& placeMetres) noexcept {
    std::rotate(newest_.begin(), newest_.end() - 1, newest_.end());
    newest_[0] = {timeSeconds, placeMetres};
    count_ = std::min(count_ + 1, newest_.size());
    if (count_ < newest_.size()) {
        return;
    }
    const double seconds = newest_[0].timeSeconds - newest_[3].timeSeconds;
    glm::dvec3 difference(0.0);
    double norm = 0.0;
    for (std::size_t index = 0; index < newest_.size(); ++index) {
        // Divided by the time from first to last, because the cubes of seconds would make the weights huge.
        double weight = 1.0;
        for (std::size_t other = 0; other < newest_.size(); ++other) {
            if (other != index) {
                weight *= seconds / (newest_[index].timeSeconds - newest_[other].timeSeconds);
            }
        }
        norm += weight * weight;
        difference += weight * (newest_[index].placeMetres - newest_[0].placeMetres);
    }
    const bool isAbove = glm::length(difference) > quantileLength * metres_ * std::sqrt(norm);
    metres_ = std::clamp(metres_ * (isAbove ? 1.0 + step * quantile : 1.0 - step * (1.0 - quantile)), leastMetres,
                         mostMetres);
}

}  // namespace haptoflow::headless
