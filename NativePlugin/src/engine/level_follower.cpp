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
    pieces_[0] = {start, logOf(levelMps2)};
    count_ = 1;
    logLevel_ = target_ = pieces_[0].logLevel;
    step_ = 0.0F;
}

void LevelFollower::takeOver(std::int64_t start, float levelMps2) noexcept {
    while (count_ > 0 && pieces_[count_ - 1].start >= start) {
        --count_;
    }
    if (count_ == capacity) {
        std::ranges::copy(pieces_.begin() + 1, pieces_.end(), pieces_.begin());
        --count_;
    }
    pieces_[count_] = {start, logOf(levelMps2)};
    ++count_;
}

void LevelFollower::setLevel(float levelMps2) noexcept {
    const float target = logOf(levelMps2);
    if (target != target_) {
        target_ = target;
        step_ = (target_ - logLevel_) / rampSamples;
    }
}

void LevelFollower::process(std::int64_t start, std::span<float> samples) noexcept {
    std::size_t piece = 0;
    for (std::size_t index = 0; index < samples.size(); ++index) {
        const std::int64_t sample = start + static_cast<std::int64_t>(index);
        while (piece + 1 < count_ && pieces_[piece + 1].start <= sample) {
            ++piece;
        }
        logLevel_ = std::abs(target_ - logLevel_) <= std::abs(step_) ? target_ : logLevel_ + step_;
        const float gain = logLevel_ - pieces_[piece].logLevel;
        if (gain != 0.0F) {
            samples[index] *= std::exp(std::clamp(gain, smallestGain, largestGain));
        }
    }
    std::copy(pieces_.begin() + static_cast<std::ptrdiff_t>(piece),
              pieces_.begin() + static_cast<std::ptrdiff_t>(count_), pieces_.begin());
    count_ -= piece;
}

}  // namespace haptoflow::engine
