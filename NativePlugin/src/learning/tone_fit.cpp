#include "learning/tone_fit.hpp"

#include "dsp/tone_filter.hpp"
#include "learning/numerics.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>

namespace haptoflow::learning {
namespace {

constexpr double lowestHz = 7.0;
constexpr double lowestTableHz = 10.0;
constexpr double highestHz = 950.0;
constexpr std::size_t cosines = 16;
constexpr std::size_t tableSpeeds = 8;
constexpr std::size_t tableForces = 4;
constexpr std::size_t tableFrequencies = model::ToneTable::maximumFrequencies;
constexpr double maximumGainDb = 30.0;
constexpr std::size_t minimumFrames = 8;
/// Decibels per unit of the natural logarithm of a power.
constexpr double decibels = 4.342944819032518;
/// Frames overlap by half, so that each counts less than an independent one.
constexpr double frameWeight = 0.62;
/// Of a frame's whole power: a quarter of what white noise would give, because spectra have peaks and levels drift.
constexpr double powerWeight = 2.0;
constexpr double powerFloor = 1e-9;

/// Prior deviations of the natural log power: of the mean, of the slopes over speed and force, and of the Gaussians.
struct Prior {
    double mean = 0.0;
    double slope = 0.0;
    double gaussian = 0.0;

    [[nodiscard]] double of(std::size_t function) const {
        return function == 0 ? mean : function < ConditionBasis::firstGaussian ? slope : gaussian;
    }
};
constexpr Prior levelPrior{.mean = std::numbers::sqrt3, .slope = 0.2, .gaussian = 0.4};
/// Narrow, because the level law has followed the recording already.
constexpr Prior lawPrior{.mean = 0.3, .slope = 0.05, .gaussian = 0.05};
constexpr Prior shapePrior{.mean = 0.2, .slope = 0.1, .gaussian = 0.1};
/// By which the deviations of shapes are multiplied; the first leaves the spectrum's shape to the network.
constexpr std::array<double, 5> freedoms{1e-3, 0.5, 1.0, 2.0, 4.0};
constexpr std::size_t folds = 4;

double warped(double hertz) {
    return std::log1p(hertz / 120.0);
}

/// The frequencies that are compared, and their cosines.
class Spectrum {
public:
    explicit Spectrum(double bandwidthHz)
        : first_(static_cast<std::size_t>(std::ceil(lowestHz / hertzPerBin))),
          end_(std::min(spectrumBins, static_cast<std::size_t>(std::min(highestHz, bandwidthHz) / hertzPerBin) + 1)) {
        for (std::size_t bin = first_; bin < end_; ++bin) {
            cosines_.push_back(cosinesAt(static_cast<double>(bin) * hertzPerBin));
        }
    }

    using Cosines = std::array<double, cosines>;
    [[nodiscard]] std::size_t count() const { return cosines_.size(); }
    [[nodiscard]] std::size_t bin(std::size_t index) const { return first_ + index; }
    [[nodiscard]] const Cosines& at(std::size_t index) const { return cosines_[index]; }
    [[nodiscard]] double highest() const { return static_cast<double>(end_ - 1) * hertzPerBin; }
    [[nodiscard]] Cosines cosinesAt(double hertz) const {
        const double from = warped(static_cast<double>(first_) * hertzPerBin);
        const double place = (warped(hertz) - from) / (warped(highest()) - from);
        Cosines values;
        for (std::size_t k = 0; k < cosines; ++k) {
            values[k] = std::cos(std::numbers::pi * static_cast<double>(k) * place);
        }
        return values;
    }
    /// Evenly over the warped frequency, from the first to the last.
    [[nodiscard]] std::vector<double> tableHertz() const {
        const double from = warped(lowestTableHz);
        std::vector<double> hertz(tableFrequencies);
        for (std::size_t i = 0; i < hertz.size(); ++i) {
            const double share = static_cast<double>(i) / static_cast<double>(hertz.size() - 1);
            hertz[i] = 120.0 * std::expm1(std::lerp(from, warped(highest()), share));
        }
        return hertz;
    }

private:
    std::size_t first_;
    std::size_t end_;
    std::vector<Cosines> cosines_;
};

/// The network's spectrum at any speed and force: the logarithm of the power at each frequency is a cubic of both.
class NetworkSpectrum {
public:
    NetworkSpectrum(const ConditionBasis& basis, const Spectrum& spectrum, std::span<const SpectrumFrame> generated)
        : basis_(basis), spectrum_(spectrum) {
        constexpr std::size_t count = ConditionBasis::cubicCount;
        constexpr std::array<double, count> deviations{8.0, 1.0, 0.5, 0.3, 0.3, 0.3, 0.15, 0.15, 0.15, 0.15};
        std::vector<double> rows;
        for (const SpectrumFrame& frame : generated) {
            const auto row = basis.cubicAt(frame.speedMps, frame.forceNewtons);
            rows.insert(rows.end(), row.begin(), row.end());
        }
        std::vector<double> powers(generated.size());
        for (std::size_t index = 0; index < spectrum.count(); ++index) {
            std::ranges::transform(generated, powers.begin(), [&](const SpectrumFrame& frame) {
                return frame.power[spectrum.bin(index)] + powerFloor;
            });
            const double mean = std::accumulate(powers.begin(), powers.end(), 0.0) / static_cast<double>(powers.size());
            for (double& power : powers) {
                power /= mean;
            }
            coefficients_.push_back(gammaRegression(powers, rows, deviations, frameWeight));
            logMeans_.push_back(std::log(mean));
        }
    }

    /// Natural logarithms of the power at each frequency.
    [[nodiscard]] std::vector<double> logPowers(double speedMps, double newtons) const {
        const auto row = basis_.cubicAt(speedMps, newtons);
        std::vector<double> logs(spectrum_.count());
        for (std::size_t index = 0; index < logs.size(); ++index) {
            logs[index] = std::inner_product(row.begin(), row.end(), coefficients_[index].begin(), logMeans_[index]);
        }
        return logs;
    }

private:
    const ConditionBasis& basis_;
    const Spectrum& spectrum_;
    std::vector<std::vector<double>> coefficients_;
    std::vector<double> logMeans_;
};

/// A frame of the recording, divided by the network's spectrum in its condition.
struct Ratios {
    std::vector<double> functions;
    std::vector<double> networkPowers;
    std::vector<double> ratios;
};

using Weights = std::array<double, cosines>;

/// The weights of the cosines, for each function of the basis.
class Shape {
public:
    explicit Shape(std::size_t functions) : coefficients_(functions * cosines) {}

    [[nodiscard]] Weights weightsAt(std::span<const double> functions) const {
        Weights weights{};
        for (std::size_t i = 0; i < functions.size(); ++i) {
            for (std::size_t k = 0; k < cosines; ++k) {
                weights[k] += functions[i] * coefficients_[i * cosines + k];
            }
        }
        return weights;
    }
    [[nodiscard]] static double logGain(const Weights& weights, const Spectrum::Cosines& at) {
        return std::inner_product(weights.begin(), weights.end(), at.begin(), 0.0);
    }
    [[nodiscard]] std::vector<double>& coefficients() { return coefficients_; }

private:
    std::vector<double> coefficients_;
};

class ShapeFit {
public:
    ShapeFit(const Spectrum& spectrum, std::span<const Ratios> frames, std::size_t functions)
        : spectrum_(spectrum), frames_(frames), functions_(functions), cosineProducts_(cosines) {
        for (std::size_t index = 0; index < spectrum.count(); ++index) {
            const auto& at = spectrum.at(index);
            for (std::size_t k = 0; k < cosines; ++k) {
                for (std::size_t l = 0; l < cosines; ++l) {
                    cosineProducts_.at(k, l) += at[k] * at[l];
                }
            }
        }
    }

    /// Without the frames of one fold, if there is one.
    [[nodiscard]] Shape fit(double freedom, std::optional<std::size_t> without) const {
        constexpr int rounds = 10;
        constexpr double settled = 1e-3;
        const std::vector<double> precisions = precisionsOf(freedom);
        const PositiveFactor information(informationOf(precisions, without));
        Shape shape(functions_);
        for (int round = 0; round < rounds; ++round) {
            const std::vector<double> change = information.solve(scoreOf(shape, precisions, without));
            double largest = 0.0;
            for (const double each : change) {
                largest = std::max(largest, std::abs(each));
            }
            const double share = largest > largestLogStep ? largestLogStep / largest : 1.0;
            for (std::size_t i = 0; i < change.size(); ++i) {
                shape.coefficients()[i] += share * change[i];
            }
            if (largest < settled) {
                break;
            }
        }
        return shape;
    }

    /// Whittle's negative log likelihood of the frames of a fold.
    [[nodiscard]] double loss(const Shape& shape, std::size_t fold) const {
        double sum = 0.0;
        for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
            if (foldOf(frame) == fold) {
                const Weights weights = shape.weightsAt(frames_[frame].functions);
                for (std::size_t index = 0; index < spectrum_.count(); ++index) {
                    const double logGain = Shape::logGain(weights, spectrum_.at(index));
                    sum += logGain + frames_[frame].ratios[index] * std::exp(-logGain);
                }
            }
        }
        return sum;
    }

private:
    /// Folds are stretches of the recording, so that what is left out does not overlap what is fitted.
    [[nodiscard]] std::size_t foldOf(std::size_t frame) const { return frame * 2 * folds / frames_.size() % folds; }

    [[nodiscard]] std::vector<double> precisionsOf(double freedom) const {
        std::vector<double> precisions;
        for (std::size_t function = 0; function < functions_; ++function) {
            for (std::size_t k = 0; k < cosines; ++k) {
                const double order = 0.25 * static_cast<double>(k);
                const double deviation = k == 0 ? levelPrior.of(function)
                                                : freedom * shapePrior.of(function) / std::sqrt(1.0 + order * order);
                precisions.push_back(1.0 / (deviation * deviation));
            }
        }
        return precisions;
    }

    [[nodiscard]] SymmetricMatrix informationOf(std::span<const double> precisions,
                                                std::optional<std::size_t> without) const {
        SymmetricMatrix conditions(functions_);
        for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
            if (foldOf(frame) != without) {
                const std::vector<double>& functions = frames_[frame].functions;
                for (std::size_t i = 0; i < functions_; ++i) {
                    for (std::size_t j = 0; j < functions_; ++j) {
                        conditions.at(i, j) += frameWeight * functions[i] * functions[j];
                    }
                }
            }
        }
        SymmetricMatrix information(precisions.size());
        for (std::size_t row = 0; row < precisions.size(); ++row) {
            for (std::size_t column = 0; column < precisions.size(); ++column) {
                information.at(row, column) = conditions.at(row / cosines, column / cosines) *
                                              cosineProducts_.at(row % cosines, column % cosines);
            }
            information.at(row, row) += precisions[row];
        }
        return information;
    }

    [[nodiscard]] std::vector<double> scoreOf(Shape& shape, std::span<const double> precisions,
                                              std::optional<std::size_t> without) const {
        std::vector<double> score(precisions.size());
        for (std::size_t i = 0; i < score.size(); ++i) {
            score[i] = -precisions[i] * shape.coefficients()[i];
        }
        for (std::size_t frame = 0; frame < frames_.size(); ++frame) {
            if (foldOf(frame) == without) {
                continue;
            }
            const Weights weights = shape.weightsAt(frames_[frame].functions);
            Weights sums{};
            for (std::size_t index = 0; index < spectrum_.count(); ++index) {
                const auto& at = spectrum_.at(index);
                const double excess = frames_[frame].ratios[index] * std::exp(-Shape::logGain(weights, at)) - 1.0;
                for (std::size_t k = 0; k < cosines; ++k) {
                    sums[k] += frameWeight * excess * at[k];
                }
            }
            for (std::size_t i = 0; i < functions_; ++i) {
                for (std::size_t k = 0; k < cosines; ++k) {
                    score[i * cosines + k] += frames_[frame].functions[i] * sums[k];
                }
            }
        }
        return score;
    }

    const Spectrum& spectrum_;
    std::span<const Ratios> frames_;
    std::size_t functions_;
    SymmetricMatrix cosineProducts_;
};

/// The freedom with which the left-out parts are the most probable.
double bestFreedom(const ShapeFit& fit) {
    double best = freedoms[0];
    double least = std::numeric_limits<double>::infinity();
    for (const double freedom : freedoms) {
        double loss = 0.0;
        for (std::size_t fold = 0; fold < folds; ++fold) {
            loss += fit.loss(fit.fit(freedom, fold), fold);
        }
        if (loss < least) {
            least = loss;
            best = freedom;
        }
    }
    return best;
}

/// What the level law leaves of the recording's power: weights of the basis, in the natural logarithm.
std::vector<double> fitLevel(const Spectrum& spectrum, std::span<const Ratios> frames, std::size_t functions) {
    std::vector<double> values;
    std::vector<double> rows;
    for (const Ratios& frame : frames) {
        double recorded = 0.0;
        for (std::size_t index = 0; index < spectrum.count(); ++index) {
            recorded += frame.ratios[index] * frame.networkPowers[index];
        }
        values.push_back(recorded);
        rows.insert(rows.end(), frame.functions.begin(), frame.functions.end());
    }
    std::vector<double> deviations(functions);
    for (std::size_t function = 0; function < functions; ++function) {
        deviations[function] = lawPrior.of(function);
    }
    return gammaRegression(values, rows, deviations, powerWeight);
}

/// The gain in dB that the engine's filter has at each bin for a row of a tone: less than the table's where that
/// changes within fewer hertz than the filter can tell apart.
std::array<double, spectrumBins> filterGainsDb(const model::ToneTable& tone, std::size_t row) {
    const auto response = responseOf(dsp::toneKernel(inference::rowCepstrum(tone, row)));
    std::array<double, spectrumBins> gains{};
    std::ranges::transform(response, gains.begin(), [](std::complex<double> each) {
        return 2.0 * decibels * std::log(std::max(std::abs(each), powerFloor));
    });
    return gains;
}

/// Shifts each row so that the network's power behind the engine's filter is that of `logPowerAt(speed, force)`.
template <typename LogPower>
void setLevels(model::ToneTable& tone, const Spectrum& spectrum, const NetworkSpectrum& network, LogPower logPowerAt) {
    for (std::size_t row = 0; row < tone.gainsDb.size(); ++row) {
        const double speed = tone.speedsMps[row % tone.speedsMps.size()];
        const double force = tone.forcesNewtons[row / tone.speedsMps.size()];
        const std::vector<double> logPowers = network.logPowers(speed, force);
        const auto gainsDb = filterGainsDb(tone, row);
        double power = 0.0;
        for (std::size_t index = 0; index < spectrum.count(); ++index) {
            power += std::exp(logPowers[index] + gainsDb[spectrum.bin(index)] / decibels);
        }
        const double shiftDb = decibels * (logPowerAt(speed, force) - std::log(power));
        for (double& gain : tone.gainsDb[row]) {
            gain = std::clamp(gain + shiftDb, -maximumGainDb, maximumGainDb);
        }
    }
}

}  // namespace

ToneConditions toneConditions(std::span<const SpectrumFrame> recorded) {
    const ConditionBasis basis(recorded);
    return {.speedsMps = basis.speedsMps(tableSpeeds), .forcesNewtons = basis.forcesNewtons(tableForces)};
}

model::ToneTable fitTone(std::span<const SpectrumFrame> recorded, std::span<const SpectrumFrame> steady,
                         std::optional<std::span<const SpectrumFrame>> alongMotion, double bandwidthHz) {
    if (recorded.size() < minimumFrames || alongMotion.value_or(steady).size() < minimumFrames) {
        return {};
    }
    const ConditionBasis basis(recorded);
    const Spectrum spectrum(bandwidthHz);
    const NetworkSpectrum inTheTable(basis, spectrum, steady);
    std::optional<NetworkSpectrum> ofMotion;
    if (alongMotion) {
        ofMotion.emplace(basis, spectrum, *alongMotion);
    }
    const NetworkSpectrum& network = ofMotion ? *ofMotion : inTheTable;
    std::vector<Ratios> frames;
    for (const SpectrumFrame& frame : recorded) {
        Ratios each{.functions = basis.at(frame.speedMps, frame.forceNewtons),
                    .networkPowers = network.logPowers(frame.speedMps, frame.forceNewtons),
                    .ratios = std::vector<double>(spectrum.count())};
        for (std::size_t index = 0; index < spectrum.count(); ++index) {
            each.networkPowers[index] = std::exp(each.networkPowers[index]);
            each.ratios[index] = (frame.power[spectrum.bin(index)] + powerFloor) / each.networkPowers[index];
        }
        frames.push_back(std::move(each));
    }
    const ShapeFit fit(spectrum, frames, basis.count());
    const Shape shape = fit.fit(bestFreedom(fit), std::nullopt);
    const std::vector<double> level = fitLevel(spectrum, frames, basis.count());

    model::ToneTable tone{.speedsMps = basis.speedsMps(tableSpeeds),
                          .forcesNewtons = basis.forcesNewtons(tableForces),
                          .frequenciesHz = spectrum.tableHertz(),
                          .gainsDb = {}};
    for (const double force : tone.forcesNewtons) {
        for (const double speed : tone.speedsMps) {
            const Weights weights = shape.weightsAt(basis.at(speed, force));
            std::vector<double> gains;
            for (const double hertz : tone.frequenciesHz) {
                const double gainDb = decibels * Shape::logGain(weights, spectrum.cosinesAt(hertz));
                gains.push_back(std::clamp(gainDb, -maximumGainDb, maximumGainDb));
            }
            tone.gainsDb.push_back(std::move(gains));
        }
    }
    setLevels(tone, spectrum, inTheTable, [&](double speed, double force) {
        const std::vector<double> functions = basis.at(speed, force);
        return std::inner_product(functions.begin(), functions.end(), level.begin(), 0.0);
    });
    return tone;
}

double MeanSpectrum::whole() const {
    return std::accumulate(power.begin() + 1, power.end(), 0.0);
}

std::vector<MeanSpectrum> meanSpectra(const SpeedBins& bins, std::span<const SpectrumFrame> frames,
                                      std::span<const double> levels, const model::ToneTable* tone) {
    std::vector<std::array<double, spectrumBins>> gainsDb;
    for (std::size_t row = 0; tone != nullptr && row < tone->gainsDb.size(); ++row) {
        gainsDb.push_back(filterGainsDb(*tone, row));
    }
    std::vector<MeanSpectrum> means(bins.count());
    for (std::size_t index = 0; index < frames.size(); ++index) {
        const SpectrumFrame& frame = frames[index];
        MeanSpectrum& mean = means[bins.binOf(frame.speedMps)];
        mean.frames += 1.0;
        std::array<double, spectrumBins> gainDb{};
        if (tone != nullptr && !gainsDb.empty()) {
            for (const auto& [row, weight] : model::ToneTable::rowsAround(tone->speedsMps, tone->forcesNewtons,
                                                                          frame.speedMps, frame.forceNewtons)) {
                for (std::size_t bin = 0; bin < spectrumBins; ++bin) {
                    gainDb[bin] += weight * gainsDb[row][bin];
                }
            }
        }
        const double power = levels.empty() ? 1.0 : levels[index] * levels[index];
        for (std::size_t bin = 0; bin < spectrumBins; ++bin) {
            mean.power[bin] += power * frame.power[bin] * std::exp(gainDb[bin] / decibels);
        }
    }
    for (MeanSpectrum& mean : means) {
        for (double& power : mean.power) {
            power /= std::max(mean.frames, 1.0);
        }
    }
    return means;
}

ToneErrors toneErrors(const SpeedBins& bins, std::span<const SpectrumFrame> recorded,
                      std::span<const SpectrumFrame> generated, const model::ToneTable& tone) {
    constexpr double lowestComparedHz = 20.0;
    constexpr double highestComparedHz = 450.0;
    const std::vector<MeanSpectrum> wanted = meanSpectra(bins, recorded, {}, nullptr);
    const std::vector<MeanSpectrum> made = meanSpectra(bins, generated, {}, &tone);
    const auto errorDb = [](double generatedPower, double recordedPower) {
        return 10.0 * std::log10((generatedPower + powerFloor) / (recordedPower + powerFloor));
    };
    ToneErrors errors;
    double total = 0.0;
    double weights = 0.0;
    for (std::size_t row = 0; row < bins.count(); ++row) {
        if (wanted[row].frames <= 0.0 || made[row].frames <= 0.0) {
            continue;
        }
        double squares = 0.0;
        double count = 0.0;
        for (std::size_t bin = 1; bin < spectrumBins; ++bin) {
            const double hertz = static_cast<double>(bin) * hertzPerBin;
            if (hertz >= lowestComparedHz && hertz <= highestComparedHz) {
                const double difference = errorDb(made[row].power[bin], wanted[row].power[bin]);
                squares += difference * difference;
                count += 1.0;
            }
        }
        total += wanted[row].frames * std::sqrt(squares / count);
        weights += wanted[row].frames;
        const double levelErrorDb = errorDb(made[row].whole(), wanted[row].whole());
        if (std::abs(levelErrorDb) > std::abs(errors.levelErrorDb)) {
            errors.levelErrorDb = levelErrorDb;
        }
    }
    errors.spectralDistanceDb = weights > 0.0 ? total / weights : 0.0;
    return errors;
}

}  // namespace haptoflow::learning
