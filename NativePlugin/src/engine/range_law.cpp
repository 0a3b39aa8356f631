#include "engine/range_law.hpp"

#include "dsp/rate_warp.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {

LevelRequest requestLevel(const Ingredients& ingredients, const RangedMotion& ranged) noexcept {
    const model::Label& label = *ingredients.entries[0].material->label;
    LevelRequest request{.levelMps2 = {}, .motion = ranged.levelMotion, .gain = 1.0F};
    if (ingredients.isBlend() || label.level) {
        request.levelMps2 = ingredients.levelMps2(ranged.levelMotion);
    } else if (label.levelOffsetDb != 0.0) {
        request.gain = static_cast<float>(std::exp(label.levelOffsetDb * std::numbers::ln10 / 20.0));
    }
    return request;
}

namespace {

constexpr double maximumGain = 16.0;

/// value / edge, at least 1.
double excess(double value, double edge) {
    return edge > 0.0 ? std::max(1.0, value / edge) : 1.0;
}

}  // namespace

RangedMotion applyRangeLaw(const model::ModelHeader& header, const Material& material,
                           const std::array<float, 2>& velocityMps, float forceNewtons, float spatialScale) noexcept {
    const double fastest = header.speedMps.maximum;
    const double force = forceNewtons;
    const double forceExcess = excess(force, header.forceNewtons.maximum);
    const auto clampedForce = static_cast<float>(std::max(force, header.forceNewtons.minimum) / forceExcess);
    const auto clamped = [&](double vx, double vy) -> std::array<float, 3> {
        const double speedExcess = excess(std::hypot(vx, vy), fastest);
        return {static_cast<float>(vx / speedExcess), static_cast<float>(vy / speedExcess), clampedForce};
    };
    const double scale = spatialScale;
    const double vx = velocityMps[0];
    const double vy = velocityMps[1];
    const double speedExcess = excess(std::hypot(vx, vy), fastest);
    const double featureExcess = excess(std::hypot(vx, vy) / scale, fastest);

    RangedMotion ranged;
    ranged.motion = clamped(vx / scale, vy / scale);
    ranged.levelMotion = clamped(vx, vy);
    ranged.levelGain = std::min(maximumGain, std::pow(speedExcess, material.speedLevelExponent) *
                                                 std::pow(forceExcess, material.forceLevelExponent));
    ranged.readingRate =
        std::clamp(std::pow(featureExcess, material.frequencyExponent), 1.0, dsp::RateWarp::maximumRatio);
    return ranged;
}

}  // namespace haptoflow::engine
