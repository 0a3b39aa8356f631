#include "engine/prepared_material.hpp"

#include "inference/segment_generator.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {

ToneTable::ToneTable(const model::ToneTable& table) : speedsMps_(table.speedsMps) {
    for (std::size_t row = 0; row < table.gainsDb.size(); ++row) {
        cepstra_.push_back(dsp::toneCepstrum([&](double frequencyHz) { return table.rowGainDb(row, frequencyHz); }));
    }
}

dsp::ToneCepstrum ToneTable::at(double speedMps) const noexcept {
    const model::LogPlace place = model::placeInLog(speedsMps_, speedMps);
    dsp::ToneCepstrum cepstrum = cepstra_[place.lower];
    if (place.share > 0.0) {
        const dsp::ToneCepstrum& upper = cepstra_[place.lower + 1];
        std::ranges::transform(cepstrum, upper, cepstrum.begin(),
                               [&place](double from, double to) { return std::lerp(from, to, place.share); });
    }
    return cepstrum;
}

double PreparedMaterial::logLevel(const std::array<float, 3>& motion) const noexcept {
    const double offset = label->levelOffsetDb * dsp::nepersPerDecibel;
    if (!label->level) {
        return grid->at(*graphLevels, motion) + offset;
    }
    const double own = label->level->logLevel(std::hypot(motion[0], motion[1]), motion[2], label->speedLevelExponent);
    return std::clamp(own + offset, -inference::maximumLogLevel, inference::maximumLogLevel);
}

double PreparedMaterial::forceExponent() const noexcept {
    return label->level ? label->level->forceExponent : label->forceLevelExponent;
}

}  // namespace haptoflow::engine
