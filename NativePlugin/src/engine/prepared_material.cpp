#include "engine/prepared_material.hpp"

#include "inference/segment_generator.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::engine {

ToneTable::ToneTable(const model::ToneTable& table) : speedsMps_(table.speedsMps), forcesNewtons_(table.forcesNewtons) {
    for (std::size_t row = 0; row < table.gainsDb.size(); ++row) {
        cepstra_.push_back(dsp::toneCepstrum([&](double frequencyHz) { return table.rowGainDb(row, frequencyHz); }));
    }
}

dsp::ToneCepstrum ToneTable::at(double speedMps, double newtons) const noexcept {
    dsp::ToneCepstrum cepstrum{};
    for (const auto& [row, weight] : model::ToneTable::rowsAround(speedsMps_, forcesNewtons_, speedMps, newtons)) {
        if (weight > 0.0) {
            std::ranges::transform(cepstrum, cepstra_[row], cepstrum.begin(),
                                   [weight](double sum, double value) { return sum + weight * value; });
        }
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
