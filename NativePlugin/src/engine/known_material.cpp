#include "engine/known_material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::engine {
namespace {

constexpr double restMps = 0.0005;
constexpr double weakestNewtons = 0.02;
constexpr double logPerDb = std::numbers::ln10 / 20.0;
// Below, a level is silence to any hand; above, beyond any limiter.
constexpr double largestLogLevel = 20.0;

/// Where a value lies in a rising list: between `lower` and the next, by `share`; held at the ends.
struct Place {
    std::size_t lower;
    double share;
};

Place placeIn(std::span<const double> rising, double value) noexcept {
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(rising, value) - rising.begin());
    if (above == 0) {
        return {0, 0.0};
    }
    if (above == rising.size()) {
        return {rising.size() - 1, 0.0};
    }
    return {above - 1, (value - rising[above - 1]) / (rising[above] - rising[above - 1])};
}

double gainDb(const model::ToneTable& table, std::span<const double> logFrequencies, std::span<const double> gains,
              double frequencyHz) {
    const Place place = placeIn(logFrequencies, std::log(std::max(frequencyHz, table.frequenciesHz.front())));
    const double gain = gains[place.lower];
    return place.share > 0.0 ? std::lerp(gain, gains[place.lower + 1], place.share) : gain;
}

std::vector<double> logarithms(std::span<const double> values) {
    std::vector<double> result(values.size());
    std::ranges::transform(values, result.begin(), [](double value) { return std::log(value); });
    return result;
}

double ownLogLevel(const model::LevelTable& table, double speedExponent, const std::array<float, 3>& motion) noexcept {
    const auto logSpeed = [](double speedMps) { return std::log(speedMps + restMps); };
    const double speed = logSpeed(std::hypot(motion[0], motion[1]));
    const double lowest = logSpeed(table.speedsMps.front());
    const double highest = logSpeed(table.speedsMps.back());
    const double inside = std::clamp(speed, lowest, highest);
    double level = table.logLevels.back();
    for (std::size_t i = 0; i + 1 < table.speedsMps.size(); ++i) {
        const double from = logSpeed(table.speedsMps[i]);
        const double to = logSpeed(table.speedsMps[i + 1]);
        if (inside <= to) {
            level = std::lerp(table.logLevels[i], table.logLevels[i + 1], (inside - from) / (to - from));
            break;
        }
    }
    level += speedExponent * (speed - inside);
    const double newtons = std::max(static_cast<double>(motion[2]), weakestNewtons);
    return level + table.forceExponent * std::log(newtons / table.forceNewtons);
}

}  // namespace

ToneTable::ToneTable(const model::ToneTable& table) : logSpeeds_(logarithms(table.speedsMps)) {
    const std::vector<double> logFrequencies = logarithms(table.frequenciesHz);
    for (const std::vector<double>& gains : table.gainsDb) {
        cepstra_.push_back(
            dsp::toneCepstrum([&](double frequencyHz) { return gainDb(table, logFrequencies, gains, frequencyHz); }));
    }
}

dsp::ToneCepstrum ToneTable::at(double speedMps) const noexcept {
    const Place place = placeIn(logSpeeds_, speedMps > 0.0 ? std::log(speedMps) : logSpeeds_.front());
    dsp::ToneCepstrum cepstrum = cepstra_[place.lower];
    if (place.share > 0.0) {
        const dsp::ToneCepstrum& upper = cepstra_[place.lower + 1];
        std::ranges::transform(cepstrum, upper, cepstrum.begin(),
                               [&place](double from, double to) { return std::lerp(from, to, place.share); });
    }
    return cepstrum;
}

double KnownMaterial::logLevel(const std::array<float, 3>& motion) const noexcept {
    const double offset = label->levelOffsetDb * logPerDb;
    if (!label->level) {
        return grid->at(*graphLevels, motion) + offset;
    }
    return std::clamp(ownLogLevel(*label->level, label->speedLevelExponent, motion) + offset, -largestLogLevel,
                      largestLogLevel);
}

double KnownMaterial::forceExponent() const noexcept {
    return label->level ? label->level->forceExponent : label->forceLevelExponent;
}

}  // namespace haptoflow::engine
