#include "skeleton/motion_features.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::skeleton {
namespace {

constexpr double restSpeedMps = 0.0005;
constexpr double referenceSpeedMps = 0.06;
constexpr double restForceNewtons = 0.02;
// Below this speed the direction fades, because it cannot be measured.
constexpr double directionSpeedMps = 0.002;

constexpr std::array<double, 5> fineHarmonics{0.5, 1.0, 2.0, 4.0, 8.0};
constexpr std::array<double, 2> smoothHarmonics{0.5, 1.0};

double speedOf(const Motion& motion) noexcept {
    return std::hypot(static_cast<double>(motion[0]), static_cast<double>(motion[1]));
}

template <std::size_t Count>
std::array<float, 8 + 2 * Count> featuresOf(const Motion& motion, const std::array<double, Count>& harmonics) noexcept {
    const LogMotion logarithms = logMotionOf(motion);
    const double speed = speedOf(motion);
    const double x = static_cast<double>(motion[0]) / (speed + directionSpeedMps);
    const double y = static_cast<double>(motion[1]) / (speed + directionSpeedMps);
    std::array<float, 8 + 2 * Count> features{};
    auto* next = features.data();
    const auto put = [&next](double value) { *next++ = static_cast<float>(value); };
    put(0.5 * logarithms.speed);
    put(0.5 * logarithms.force);
    put(x);
    put(y);
    put(x * x - y * y);
    put(2.0 * x * y);
    for (const double harmonic : harmonics) {
        put(std::sin(harmonic * logarithms.speed));
        put(std::cos(harmonic * logarithms.speed));
    }
    put(speed);
    put(0.2 * static_cast<double>(motion[2]));
    return features;
}

static_assert(fineFeatures == 8 + 2 * fineHarmonics.size());
static_assert(smoothFeatures == 8 + 2 * smoothHarmonics.size());

}  // namespace

LogMotion logMotionOf(const Motion& motion) noexcept {
    return {.speed = std::log((speedOf(motion) + restSpeedMps) / referenceSpeedMps),
            .force = std::log(std::max(static_cast<double>(motion[2]), 0.0) + restForceNewtons)};
}

std::array<float, fineFeatures> fineFeaturesOf(const Motion& motion) noexcept {
    return featuresOf(motion, fineHarmonics);
}

std::array<float, smoothFeatures> smoothFeaturesOf(const Motion& motion) noexcept {
    return featuresOf(motion, smoothHarmonics);
}

}  // namespace haptoflow::skeleton
