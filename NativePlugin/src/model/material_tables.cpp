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

double ToneTable::gainDb(double speedMps, double frequencyHz) const noexcept {
    const LogPlace place = placeInLog(speedsMps, speedMps);
    const double gain = rowGainDb(place.lower, frequencyHz);
    return place.share > 0.0 ? std::lerp(gain, rowGainDb(place.lower + 1, frequencyHz), place.share) : gain;
}

}  // namespace haptoflow::model
