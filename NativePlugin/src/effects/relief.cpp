#include "effects/relief.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::effects {
namespace {

constexpr double leastStepsPerSecond = 24000.0;
constexpr double shortestSeconds = 0.001;
constexpr double longestSeconds = 0.1;
// A tip that is further from where a state says was put there.
constexpr double jumpMetres = 0.02;
constexpr double steepest = std::numbers::sqrt2;
constexpr double forcesPerSecond = 100.0;
constexpr double perKilogram = 1.0 / Relief::tipKilograms;
// A tip that nothing presses would never come down again.
constexpr double leastNewtons = 0.05;
constexpr double farthestMetres = 0.005;
constexpr double quietSeconds = 0.05;
constexpr double jumpSeconds = 0.001;
constexpr double lowestHz = 10.0;
constexpr double highestHz = 800.0;
// Of a Butterworth filter of the second order, and of the two sections of one of the fourth.
constexpr double secondOrder = 0.70710678;
constexpr std::array<double, 2> fourthOrder{0.54119610, 1.30656296};

/// The hyperbolic tangent's Pade approximant, which is monotonic and ends at 1.
double limited(double value, double largest) noexcept {
    if (largest <= 0.0) {
        return 0.0;
    }
    const double x = std::clamp(value / largest, -3.0, 3.0);
    return largest * x * (27.0 + x * x) / (27.0 + 9.0 * x * x);
}

double finite(double value, double lowest, double highest) noexcept {
    return std::isfinite(value) ? std::clamp(value, lowest, highest) : 0.0;
}

}  // namespace

Relief::Section::Section(Kind kind, double frequencyHz, double quality, double rateHz) noexcept {
    // Bristow-Johnson, "Cookbook formulae for audio EQ biquad filter coefficients".
    const double turn = 2.0 * std::numbers::pi * frequencyHz / rateHz;
    const double width = std::sin(turn) / (2.0 * quality);
    const double edge = kind == Kind::lowPass ? 1.0 - std::cos(turn) : 1.0 + std::cos(turn);
    const double norm = 1.0 / (1.0 + width);
    forward_ = {0.5 * edge * norm, (kind == Kind::lowPass ? edge : -edge) * norm, 0.5 * edge * norm};
    back_ = {-2.0 * std::cos(turn) * norm, (1.0 - width) * norm};
}

double Relief::Section::next(double sample) noexcept {
    const double filtered = forward_[0] * sample + first_;
    first_ = forward_[1] * sample - back_[0] * filtered + second_;
    second_ = forward_[2] * sample - back_[1] * filtered;
    return filtered;
}

Relief::Relief(double sampleRateHz)
    : rateHz_(sampleRateHz),
      steps_(static_cast<std::size_t>(std::max(1.0, std::ceil(leastStepsPerSecond / sampleRateHz)))),
      stepsPerSecond_(sampleRateHz * static_cast<double>(steps_)),
      stepSeconds_(1.0 / stepsPerSecond_),
      gate_(sampleRateHz),
      highPass_(Section::Kind::highPass, lowestHz, secondOrder, sampleRateHz),
      lowPass_{Section(Section::Kind::lowPass, highestHz, fourthOrder[0], sampleRateHz),
               Section(Section::Kind::lowPass, highestHz, fourthOrder[1], sampleRateHz)} {}

void Relief::follow(const ReliefContact& contact) noexcept {
    const bool isOtherMap = contact.map != contact_.map;
    if (contact.map == nullptr || !(contact.largestMps2 > 0.0F)) {
        end();
        return;
    }
    const double speedBefore = contact_.speedMps;
    const double stiffnessBefore = contact_.stiffnessNewtonsPerMetre;
    contact_ = contact;
    contact_.stiffnessNewtonsPerMetre = finite(contact.stiffnessNewtonsPerMetre, leastStiffness, mostStiffness);
    damping_ = 2.0 * dampingRatio * std::sqrt(contact_.stiffnessNewtonsPerMetre * tipKilograms);
    tipMetres_ = surfaceMetres_ - (surfaceMetres_ - tipMetres_) * stiffnessBefore / contact_.stiffnessNewtonsPerMetre;
    contact_.speedMps = finite(contact.speedMps, 0.0, 20.0);
    contact_.forceNewtons = std::max(leastNewtons, finite(contact.forceNewtons, 0.0, 1000.0));
    contact_.largestMps2 = finite(contact.largestMps2, 0.0, 1e5);
    speedMps_ = std::max(speedBefore, contact_.speedMps);
    const double seconds = std::clamp(std::isfinite(contact.arrivalSeconds) ? contact.arrivalSeconds : 0.0,
                                      shortestSeconds, longestSeconds);
    const ReliefDescription& description = contact_.map->description();
    const std::array<double, 2> counts{static_cast<double>(description.columns), static_cast<double>(description.rows)};
    std::array<double, 2> missing{};
    for (std::size_t side = 0; side < 2; ++side) {
        contact_.place[side] = finite(contact.place[side], -1e9, 1e9);
        missing[side] = contact_.place[side] - place_[side];
    }
    const double farthest = std::max(jumpMetres, 3.0 * speedMps_ * seconds);
    const auto isTooFar = [&missing, &size = description.sizeMetres, farthest] {
        return std::hypot(missing[0] * size[0], missing[1] * size[1]) > farthest;
    };
    if (description.isTiled && isTooFar()) {
        // A mesh may go on at the opposite rim of a tile.
        std::ranges::for_each(missing, [](double& tiles) { tiles -= std::round(tiles); });
    }
    const bool isAtRest = isIdle_ && contact_.speedMps == 0.0;
    if (isOtherMap || isAtRest || isTooFar()) {
        place_ = contact_.place;
        stepsLeft_ = 0;
        resolution_ = 0.0;
        settle();
    } else {
        const double steps = seconds * stepsPerSecond_;
        placePerStep_ = {missing[0] / steps, missing[1] / steps};
        stepsLeft_ = static_cast<std::size_t>(2.0 * steps);
        resolution_ = contact_.map->resolutionFor(std::hypot(missing[0] * counts[0], missing[1] * counts[1]) / seconds);
    }
    gate_.open();
    isIdle_ = isAtRest;
}

void Relief::keep(const ReliefMap* map) noexcept {
    if (contact_.map != map) {
        end();
    }
}

void Relief::end() noexcept {
    // The tip rings on over an even surface while the gate closes.
    contact_.map = nullptr;
    contact_.speedMps = 0.0;
    stepsLeft_ = 0;
    gate_.close();
}

void Relief::settle() noexcept {
    jump_ = isIdle_ ? 0.0 : newest_;
    forceNewtons_ = contact_.forceNewtons;
    surfaceMetres_ = contact_.map->heightMetres(place_, resolution_);
    tipMetres_ = surfaceMetres_ - forceNewtons_ / contact_.stiffnessNewtonsPerMetre;
    tipMps_ = 0.0;
}

double Relief::nextAcceleration() noexcept {
    if (stepsLeft_ > 0) {
        --stepsLeft_;
        place_[0] += placePerStep_[0];
        place_[1] += placePerStep_[1];
    }
    double riseMps = 0.0;
    if (contact_.map != nullptr) {
        const double limit = steepest * speedMps_;
        const double wantedMps = (contact_.map->heightMetres(place_, resolution_) - surfaceMetres_) * stepsPerSecond_;
        riseMps = std::clamp(wantedMps, -limit, limit);
        surfaceMetres_ += riseMps * stepSeconds_;
    }
    forceNewtons_ += (contact_.forceNewtons - forceNewtons_) * stepSeconds_ * forcesPerSecond;
    const double depth = surfaceMetres_ - tipMetres_;
    const double contactNewtons =
        depth > 0.0 ? std::max(0.0, contact_.stiffnessNewtonsPerMetre * depth + damping_ * (riseMps - tipMps_)) : 0.0;
    const double acceleration = (contactNewtons - forceNewtons_) * perKilogram;
    tipMps_ += acceleration * stepSeconds_;
    tipMetres_ = std::min(tipMetres_ + tipMps_ * stepSeconds_, surfaceMetres_ + farthestMetres);
    return acceleration;
}

void Relief::process(std::span<float> samplesMps2) noexcept {
    const double sampleSeconds = 1.0 / rateHz_;
    const double sampleShare = 1.0 / static_cast<double>(steps_);
    const double jumpDecay = std::exp(-1.0 / (jumpSeconds * rateHz_));
    for (float& sample : samplesMps2) {
        double acceleration = 0.0;
        for (std::size_t step = 0; step < steps_; ++step) {
            acceleration += nextAcceleration();
        }
        newest_ = acceleration * sampleShare + jump_;
        jump_ *= jumpDecay;
        const double filtered = lowPass_[1].next(lowPass_[0].next(highPass_.next(newest_)));
        sample += static_cast<float>(limited(filtered, contact_.largestMps2)) * gate_.nextGain();
        quietSeconds_ =
            contact_.speedMps > 0.0 || std::abs(filtered) > imperceptibleMps2 ? 0.0 : quietSeconds_ + sampleSeconds;
    }
    if (gate_.isClosed()) {
        reset();
    }
    isIdle_ = isIdle_ || quietSeconds_ > quietSeconds;
}

void Relief::reset() noexcept {
    gate_.reset();
    highPass_.reset();
    lowPass_[0].reset();
    lowPass_[1].reset();
    contact_ = {};
    jump_ = newest_ = 0.0;
    isIdle_ = true;
}

}  // namespace haptoflow::effects
