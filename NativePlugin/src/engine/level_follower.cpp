#include "engine/level_follower.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr float rampSamples = 8.0F;
constexpr float lowestLevelMps2 = 1e-6F;
constexpr float neperPerDecibel = std::numbers::ln10_v<float> / 20.0F;
constexpr float largestGain = 12.0F * neperPerDecibel;
constexpr float smallestGain = -40.0F * neperPerDecibel;

float logOf(float levelMps2) noexcept {
    const bool isUsable = levelMps2 > lowestLevelMps2 && std::isfinite(levelMps2);
    return std::log(isUsable ? levelMps2 : lowestLevelMps2);
}

}  // namespace

void LevelFollower::begin(std::int64_t start, float levelMps2) noexcept {
    logLevel_ = target_ = logOf(levelMps2);
    step_ = 0.0F;
    pieces_.begin({start, logLevel_});
}

void LevelFollower::takeOver(std::int64_t start, float levelMps2) noexcept {
    pieces_.add({start, logOf(levelMps2)});
}

void LevelFollower::setLevel(float levelMps2) noexcept {
    const float target = logOf(levelMps2);
    if (target != target_) {
        target_ = target;
        step_ = (target_ - logLevel_) / rampSamples;
    }
}

void LevelFollower::process(std::int64_t start, std::span<float> samples) noexcept {
    for (float& sample : samples) {
        logLevel_ = std::abs(target_ - logLevel_) <= std::abs(step_) ? target_ : logLevel_ + step_;
        const float gain = logLevel_ - pieces_.at(start).logLevel;
        if (gain != 0.0F) {
            sample *= std::exp(std::clamp(gain, smallestGain, largestGain));
        }
        ++start;
    }
}

}  // namespace haptoflow::engine
