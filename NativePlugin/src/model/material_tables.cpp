#include "model/material_tables.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::model {

LogPlace placeInLog(std::span<const double> rising, double value) noexcept {
    if (!(value > rising.front())) {
        return {};
    }
    if (value >= rising.back()) {
        return {.lower = rising.size() - 1, .share = 0.0};
    }
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(rising, value) - rising.begin());
    const double from = std::log(rising[above - 1]);
    return {.lower = above - 1, .share = (std::log(value) - from) / (std::log(rising[above]) - from)};
}

double LevelTable::logSpeed(double speedMps) noexcept {
    return std::log(speedMps + restMps);
}

double LevelTable::logLevel(double speedMps, double newtons, double speedExponent) const noexcept {
    const double speed = logSpeed(speedMps);
    const double inside = std::clamp(speed, logSpeed(speedsMps.front()), logSpeed(speedsMps.back()));
    double level = logLevels.back();
    for (std::size_t i = 0; i + 1 < speedsMps.size(); ++i) {
        const double from = logSpeed(speedsMps[i]);
        const double to = logSpeed(speedsMps[i + 1]);
        if (inside <= to) {
            level = std::lerp(logLevels[i], logLevels[i + 1], (inside - from) / (to - from));
            break;
        }
    }
    level += speedExponent * (speed - inside);
    return level + forceExponent * std::log(std::max(newtons, minimumForceNewtons) / forceNewtons);
}

double ToneTable::rowGainDb(std::size_t row, double frequencyHz) const noexcept {
    const std::vector<double>& gains = gainsDb[row];
    const LogPlace place = placeInLog(frequenciesHz, frequencyHz);
    const double gain = gains[place.lower];
    return place.share > 0.0 ? std::lerp(gain, gains[place.lower + 1], place.share) : gain;
}

std::array<ToneTable::WeightedRow, 4> ToneTable::rowsAround(std::span<const double> speedsMps,
                                                            std::span<const double> forcesNewtons, double speedMps,
                                                            double newtons) noexcept {
    const LogPlace speed = placeInLog(speedsMps, speedMps);
    const LogPlace force = placeInLog(forcesNewtons, newtons);
    // At an end, the row beyond it would have no weight: the last one stands in its place.
    const std::size_t faster = std::min(speed.lower + 1, speedsMps.size() - 1);
    const std::size_t lighter = force.lower * speedsMps.size();
    const std::size_t firmer = std::min(force.lower + 1, forcesNewtons.size() - 1) * speedsMps.size();
    return {{{lighter + speed.lower, (1.0 - force.share) * (1.0 - speed.share)},
             {lighter + faster, (1.0 - force.share) * speed.share},
             {firmer + speed.lower, force.share * (1.0 - speed.share)},
             {firmer + faster, force.share * speed.share}}};
}

double ToneTable::gainDb(double speedMps, double newtons, double frequencyHz) const noexcept {
    double gain = 0.0;
    for (const WeightedRow& each : rowsAround(speedsMps, forcesNewtons, speedMps, newtons)) {
        if (each.weight > 0.0) {
            gain += each.weight * rowGainDb(each.row, frequencyHz);
        }
    }
    return gain;
}

}  // namespace haptoflow::model
