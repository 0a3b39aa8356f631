#include "effects/compensation.hpp"

#include "dsp/limiter.hpp"
#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::effects {
namespace {

constexpr double lowestHz = 5.0;
constexpr double pointsPerOctave = 24.0;
constexpr std::size_t points = 289;
constexpr double transitionOctaves = 1.0;
// The compensation does not fill notches narrower than this: they are measurement artefacts or shift with temperature
// and grip.
constexpr double smoothingOctaves = 1.0 / 6.0;
// If all gains are smaller than this, no filter is built.
constexpr double transparentDecibels = 0.05;
constexpr double broadbandLowestHz = 20.0;
constexpr double broadbandHighestHz = 1000.0;

double hzAt(std::size_t point) {
    return lowestHz * std::exp2(static_cast<double>(point) / pointsPerOctave);
}

double inDecibels(double factor) {
    return 20.0 * std::log10(factor);
}

double asFactor(double decibels) {
    return std::pow(10.0, decibels / 20.0);
}

/// Mean power gain of a response for broadband noise: the larger of the gains for white and for pink noise.
template <typename Gain>
double broadbandPower(const Gain& gainAt) {
    double pink = 0.0;
    double white = 0.0;
    double octaves = 0.0;
    double bandwidth = 0.0;
    for (std::size_t point = 0; point < points; ++point) {
        const double hz = hzAt(point);
        if (hz >= broadbandLowestHz && hz <= broadbandHighestHz) {
            const double gain = gainAt(point);
            pink += gain * gain;
            octaves += 1.0;
            white += gain * gain * hz;
            bandwidth += hz;
        }
    }
    return std::max(pink / octaves, white / bandwidth);
}

std::vector<double> smoothedDecibels(const ActuatorProfile& profile) {
    constexpr int readings = 16;
    std::vector<double> smoothed(points);
    for (std::size_t point = 0; point < points; ++point) {
        double power = 0.0;
        for (int reading = 0; reading < readings; ++reading) {
            const double octaves = smoothingOctaves * ((reading + 0.5) / readings - 0.5);
            const double factor = asFactor(profile.magnitudeDecibelsAt(hzAt(point) * std::exp2(octaves)));
            power += factor * factor;
        }
        smoothed[point] = 10.0 * std::log10(power / readings);
    }
    return smoothed;
}

/// Weight of the compensation: 1 in the band, 0 an octave or more outside it, a raised cosine between.
double shareOf(double hz, const std::array<double, 2>& bandHz) {
    const double octavesOutside = std::max({std::log2(bandHz[0] / hz), std::log2(hz / bandHz[1]), 0.0});
    const double way = std::min(octavesOutside / transitionOctaves, 1.0);
    return 0.5 + 0.5 * std::cos(std::numbers::pi * way);
}

/// The gains in dB that level an actuator with these magnitudes to `levelDecibels`.
std::vector<double> gainsFor(const std::vector<double>& actuatorDecibels, double levelDecibels, double boostDecibels,
                             const std::array<double, 2>& bandHz) {
    // Tikhonov regularisation: p / (p^2 + b) has its maximum, 1 / (2 sqrt(b)), at p = sqrt(b).
    const double bound = 0.25 / std::pow(asFactor(boostDecibels), 2.0);
    std::vector<double> gains(points);
    for (std::size_t point = 0; point < points; ++point) {
        const double magnitude = asFactor(actuatorDecibels[point] - levelDecibels);
        const double inverse = magnitude / (magnitude * magnitude + bound);
        gains[point] = shareOf(hzAt(point), bandHz) * std::max(inDecibels(inverse), -Compensation::maximumCutDecibels);
    }
    return gains;
}

double powerAt(const std::vector<double>& actuatorDecibels, double levelDecibels, double boostDecibels,
               const std::array<double, 2>& bandHz) {
    const std::vector<double> gains = gainsFor(actuatorDecibels, levelDecibels, boostDecibels, bandHz);
    return broadbandPower([&gains](std::size_t point) { return asFactor(gains[point]); });
}

/// The highest level to which the actuator can be raised without increasing the power of broadband noise. If no level
/// increases it, the level with the smallest loss. The power is not monotone in the level: once frequencies reach the
/// maximum boost or are given up, it falls again.
double findLevel(const std::vector<double>& actuatorDecibels, double boostDecibels,
                 const std::array<double, 2>& bandHz) {
    constexpr double step = 0.5;
    const auto power = [&](double level) { return powerAt(actuatorDecibels, level, boostDecibels, bandHz); };
    const auto [lowest, highest] = std::ranges::minmax(actuatorDecibels);
    std::optional<double> crossing;
    double levelOfMaximum = lowest;
    double maximumPower = 0.0;
    double powerBelow = 0.0;
    for (double level = lowest - step; level < highest + Compensation::maximumCutDecibels; level += step) {
        const double here = power(level);
        if (here > 1.0 && powerBelow <= 1.0) {
            crossing = level - step;
        }
        if (here >= maximumPower) {
            levelOfMaximum = level;
            maximumPower = here;
        }
        powerBelow = here;
    }
    if (!crossing) {
        return levelOfMaximum;
    }
    double below = *crossing;
    double above = below + step;
    for (int halving = 0; halving < 30; ++halving) {
        const double middle = 0.5 * (below + above);
        (power(middle) > 1.0 ? above : below) = middle;
    }
    return below;
}

std::vector<ResponsePoint> minimumPhaseResponse(const std::vector<double>& gainDecibels, double sampleRateHz) {
    std::vector<double> nepers(points);
    std::ranges::transform(gainDecibels, nepers.begin(),
                           [](double decibels) { return decibels * std::numbers::ln10 / 20.0; });
    const std::vector<double> phase = minimumPhaseRadians(nepers, 1.0 / pointsPerOctave);
    std::vector<ResponsePoint> response;
    for (std::size_t point = 0; point < points && hzAt(point) < 0.45 * sampleRateHz; ++point) {
        response.push_back({hzAt(point), std::polar(std::exp(nepers[point]), phase[point])});
    }
    return response;
}

double largestGain(const ParallelFilter& filter, double sampleRateHz) {
    double largest = 0.0;
    for (std::size_t point = 0; point < points && hzAt(point) < 0.5 * sampleRateHz; ++point) {
        largest = std::max(largest, std::abs(filter.response(hzAt(point))));
    }
    return inDecibels(largest);
}

void requireSettings(double sampleRateHz, const CompensationSettings& settings) {
    (void)dsp::requireOutputRate(sampleRateHz);
    if (!(settings.maximumBoostDecibels >= 0.0 && settings.maximumBoostDecibels <= 24.0)) {
        throw std::invalid_argument("the largest boost is " + std::to_string(settings.maximumBoostDecibels) +
                                    " dB; expected 0 to 24 dB");
    }
    const auto [low, high] = settings.bandHz;
    if (!(low >= broadbandLowestHz && high <= broadbandHighestHz && low < high)) {
        throw std::invalid_argument("the band is " + std::to_string(low) + " to " + std::to_string(high) +
                                    " Hz; expected two rising frequencies from 20 to 1000 Hz");
    }
}

}  // namespace

Compensation::Compensation(const ActuatorProfile& profile, double sampleRateHz, const CompensationSettings& settings)
    : bandHz_{std::max(settings.bandHz[0], profile.frequencyHz.front()),
              std::min(settings.bandHz[1], profile.frequencyHz.back())} {
    requireSettings(sampleRateHz, settings);
    if (!(bandHz_[0] < bandHz_[1])) {
        return;
    }
    const std::vector<double> actuator = smoothedDecibels(profile);
    levelDecibels_ = findLevel(actuator, settings.maximumBoostDecibels, bandHz_);
    // If the fitted filter exceeds the maximum boost, fit again with a lower bound.
    double bound = settings.maximumBoostDecibels;
    for (int attempt = 0; attempt < 4; ++attempt) {
        const std::vector<double> gains = gainsFor(actuator, levelDecibels_, bound, bandHz_);
        if (std::ranges::all_of(gains, [](double gain) { return std::abs(gain) < transparentDecibels; })) {
            filter_.reset();
            return;
        }
        filter_.emplace(minimumPhaseResponse(gains, sampleRateHz), sampleRateHz);
        const double excess = largestGain(*filter_, sampleRateHz) - settings.maximumBoostDecibels;
        if (excess <= 0.0) {
            break;
        }
        bound = std::max(bound - excess, 0.0);
    }
    const double excess = std::max(largestGain(*filter_, sampleRateHz) - settings.maximumBoostDecibels, 0.0);
    const double power = broadbandPower([this](std::size_t point) { return std::abs(filter_->response(hzAt(point))); });
    filter_->scale(asFactor(-excess) / std::sqrt(std::max(power, 1.0)));
    tailSeconds_ = filter_->tailSeconds(dsp::SoftLimiter::defaultFullScaleMps2, imperceptibleMps2);
    for (std::size_t point = 0; point < points; ++point) {
        if (hzAt(point) >= bandHz_[0] && hzAt(point) <= bandHz_[1]) {
            latencySeconds_ = std::max(latencySeconds_, groupDelaySeconds(hzAt(point)));
        }
    }
}

void Compensation::process(std::span<float> samplesMps2) noexcept {
    if (!filter_ || samplesMps2.empty()) {
        return;
    }
    const bool isSilent = std::ranges::all_of(samplesMps2, [](float sample) { return sample == 0.0F; });
    if (isSilent && isIdle_) {
        return;
    }
    filter_->process(samplesMps2);
    isIdle_ = isSilent && filter_->envelope() < imperceptibleMps2;
    if (isIdle_) {
        filter_->reset();
    }
}

void Compensation::reset() noexcept {
    if (filter_) {
        filter_->reset();
    }
    isIdle_ = true;
}

double Compensation::gainDecibels(double frequencyHz) const noexcept {
    return filter_ ? inDecibels(std::abs(filter_->response(frequencyHz))) : 0.0;
}

double Compensation::groupDelaySeconds(double frequencyHz) const noexcept {
    if (!filter_) {
        return 0.0;
    }
    const double half = 1e-3 * frequencyHz;
    const std::complex<double> turned =
        filter_->response(frequencyHz + half) * std::conj(filter_->response(frequencyHz - half));
    return -std::arg(turned) / (2.0 * std::numbers::pi * 2.0 * half);
}

}  // namespace haptoflow::effects
