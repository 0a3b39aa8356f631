#include "inference/prepared_tone.hpp"

#include <algorithm>

namespace haptoflow::inference {

dsp::ToneCepstrum rowCepstrum(const model::ToneTable& tone, std::size_t row) {
    return dsp::toneCepstrum([&](double frequencyHz) { return tone.rowGainDb(row, frequencyHz); });
}

PreparedTone::PreparedTone(const model::ToneTable& table)
    : speedsMps_(table.speedsMps), forcesNewtons_(table.forcesNewtons) {
    for (std::size_t row = 0; row < table.gainsDb.size(); ++row) {
        cepstra_.push_back(rowCepstrum(table, row));
    }
}

dsp::ToneCepstrum PreparedTone::at(double speedMps, double newtons) const noexcept {
    dsp::ToneCepstrum cepstrum{};
    for (const auto& [row, weight] : model::ToneTable::rowsAround(speedsMps_, forcesNewtons_, speedMps, newtons)) {
        if (weight > 0.0) {
            std::ranges::transform(cepstrum, cepstra_[row], cepstrum.begin(),
                                   [share = weight](double sum, double value) { return sum + share * value; });
        }
    }
    return cepstrum;
}

}  // namespace haptoflow::inference
