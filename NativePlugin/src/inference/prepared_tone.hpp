#pragma once

#include "dsp/tone_filter.hpp"
#include "model/material_tables.hpp"

#include <cstddef>
#include <vector>

namespace haptoflow::inference {

/// The cepstrum of one row of a tone. Allocates.
[[nodiscard]] dsp::ToneCepstrum rowCepstrum(const model::ToneTable& tone, std::size_t row);

/// A tone as a function of speed and force, stored as cepstra. Immutable.
class PreparedTone {
public:
    /// Computes a cepstrum for each row. Allocates.
    explicit PreparedTone(const model::ToneTable& table);

    /// Interpolates the gains in dB over the logarithms of speed and force; constant beyond the ends.
    [[nodiscard]] dsp::ToneCepstrum at(double speedMps, double newtons) const noexcept;

private:
    std::vector<double> speedsMps_;
    std::vector<double> forcesNewtons_;
    std::vector<dsp::ToneCepstrum> cepstra_;
};

}  // namespace haptoflow::inference
