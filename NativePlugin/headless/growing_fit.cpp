#include "headless/growing_fit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace haptoflow::headless {
namespace {

// A cubic of so many deviations of noise ends the window, of one more for each of these speeds by which noise alone
// moves the velocity: a false alarm costs as much.
constexpr double cubicDeviations = 3.0;
constexpr double costMps = 0.01;
// So many variances of noise are left out of the square of the curvature.
constexpr double curvatureVariances = 4.0;
// Windows grow by this share, so that many places are fitted only a few times.
constexpr std::size_t growth = 8;

}  // namespace

void GrowingFit::add(double timeSeconds, const glm::dvec3& placeMetres) noexcept {
    entries_[count_++] = {timeSeconds, placeMetres};
}

glm::dvec3 GrowingFit::endVelocity(double noiseMetres) const noexcept {
    glm::dvec3 velocity(0.0);
    for (std::size_t size = 2; size <= count_; size += std::max<std::size_t>(1, size / growth)) {
        const Fit fit = fitNewest(size, noiseMetres);
        if (!fit.agrees) {
            break;
        }
        velocity = fit.endVelocityMps;
    }
    return velocity;
}

/// The difference between the means of the newer and the older half, divided by that of their times (Wald 1940).
glm::dvec3 GrowingFit::meanVelocity(double seconds) const noexcept {
    std::size_t size = std::min<std::size_t>(count_, 3);
    while (size < count_ && entries_[0].timeSeconds - entries_[size].timeSeconds <= seconds) {
        ++size;
    }
    double duration = 0.0;
    glm::dvec3 distance(0.0);
    for (std::size_t newer = 0; newer < size / 2; ++newer) {
        const Entry& older = entries_[size - 1 - newer];
        duration += entries_[newer].timeSeconds - older.timeSeconds;
        distance += entries_[newer].placeMetres - older.placeMetres;
    }
    return duration > 0.0 ? distance / duration : glm::dvec3(0.0);
}

/// Fits with polynomials that are orthogonal over the times: t - mean, and two more by Gram and Schmidt. Times and
/// places count from the newest, so that nothing is lost far from the origin.
GrowingFit::Fit GrowingFit::fitNewest(std::size_t size, double noiseMetres) const noexcept {
    const auto number = static_cast<double>(size);
    double meanSeconds = 0.0;
    for (std::size_t index = 0; index < size; ++index) {
        meanSeconds += entries_[index].timeSeconds - entries_[0].timeSeconds;
    }
    meanSeconds /= number;

    double second = 0.0;
    double third = 0.0;
    double fourth = 0.0;
    glm::dvec3 slope(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double square = linear * linear;
        second += square;
        third += square * linear;
        fourth += square * square;
        slope += linear * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    slope /= second;
    if (size == 2) {
        return {slope, true};
    }

    const double skew = third / second;
    const double spread = second / number;
    double norm = 0.0;
    double cross = 0.0;
    glm::dvec3 curvature(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double quadratic = (linear - skew) * linear - spread;
        norm += quadratic * quadratic;
        cross += quadratic * linear * linear * linear;
        curvature += quadratic * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    curvature /= norm;

    const double variance = noiseMetres * noiseMetres;
    const double explained = glm::dot(curvature, curvature) * norm;
    const double surplus = explained - curvatureVariances * variance;
    const double share = surplus > 0.0 ? surplus / explained : 0.0;
    const double lever = -2.0 * meanSeconds - skew;
    const glm::dvec3 velocity = slope + share * lever * curvature;
    if (size == 3) {
        return {velocity, true};
    }

    const double tilt = cross / norm;
    const double lean = fourth / second;
    double cubicNorm = 0.0;
    glm::dvec3 cubic(0.0);
    for (std::size_t index = 0; index < size; ++index) {
        const double linear = entries_[index].timeSeconds - entries_[0].timeSeconds - meanSeconds;
        const double quadratic = (linear - skew) * linear - spread;
        const double value = linear * linear * linear - tilt * quadratic - lean * linear - third / number;
        cubicNorm += value * value;
        cubic += value * (entries_[index].placeMetres - entries_[0].placeMetres);
    }
    const double velocityVariance = variance * (1.0 / second + lever * lever / norm);
    const double deviations = cubicDeviations + std::sqrt(velocityVariance) / costMps;
    return {velocity, glm::dot(cubic, cubic) <= deviations * deviations * variance * cubicNorm};
}

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
