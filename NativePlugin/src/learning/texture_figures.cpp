#include "learning/texture_figures.hpp"

#include "dsp/fourier_transform.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::learning {
namespace {

constexpr std::array<std::size_t, 3> pieceSamples{4, 20, 60};
constexpr double powerFloor = 1e-3;
constexpr double samplesPerBin = 2800.0;
constexpr double narrowestBin = 0.18;

const std::array<double, spectrumSamples>& hannWindow() {
    static const auto window = [] {
        std::array<double, spectrumSamples> values{};
        for (std::size_t i = 0; i < spectrumSamples; ++i) {
            values[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(i) /
                                             static_cast<double>(spectrumSamples));
        }
        return values;
    }();
    return window;
}

}  // namespace

std::size_t SpeedBins::binOf(double speedMps) const {
    return static_cast<std::size_t>(std::ranges::upper_bound(edgesMps, speedMps) - edgesMps.begin());
}

SpeedBins SpeedBins::divide(std::vector<double> speedsMps, std::size_t most) {
    std::ranges::sort(speedsMps);
    const auto total = static_cast<double>(speedsMps.size());
    const auto bins = std::clamp<std::size_t>(static_cast<std::size_t>(total / samplesPerBin), 1, most);
    SpeedBins result;
    double last = speedsMps.front();
    for (std::size_t i = 1; i < bins; ++i) {
        const double edge =
            speedsMps[static_cast<std::size_t>(total * static_cast<double>(i) / static_cast<double>(bins))];
        if (std::log(edge / last) >= narrowestBin && std::log(speedsMps.back() / edge) >= narrowestBin) {
            result.edgesMps.push_back(edge);
            last = edge;
        }
    }
    std::vector<double> sums(result.edgesMps.size() + 1);
    std::vector<double> counts(sums.size());
    for (const double speed : speedsMps) {
        const std::size_t bin = result.binOf(speed);
        sums[bin] += std::log(speed);
        counts[bin] += 1.0;
    }
    for (std::size_t bin = 0; bin < sums.size(); ++bin) {
        result.centresMps.push_back(std::exp(sums[bin] / std::max(counts[bin], 1.0)));
    }
    return result;
}

std::array<double, spectrumBins> powerOf(std::span<const float, spectrumSamples> wave) {
    std::vector<std::complex<double>> values(spectrumSamples);
    for (std::size_t i = 0; i < spectrumSamples; ++i) {
        values[i] = static_cast<double>(wave[i]) * hannWindow()[i];
    }
    dsp::fourierTransform(values, dsp::Direction::forward);
    // Scales the sum of the bins to the mean square: the window's is 3/8, and inner bins represent two frequencies.
    constexpr double windowPower = 0.375;
    constexpr auto length = static_cast<double>(spectrumSamples);
    std::array<double, spectrumBins> power{};
    for (std::size_t bin = 0; bin < spectrumBins; ++bin) {
        const double sides = bin == 0 || bin + 1 == spectrumBins ? 1.0 : 2.0;
        power[bin] = sides * std::norm(values[bin]) / (windowPower * length * length);
    }
    return power;
}

TextureMeter::TextureMeter(std::size_t bins) : sums_(bins) {}

void TextureMeter::addLines(Sums& sums, std::span<const float, spectrumSamples> wave,
                            std::span<const RibTravel> ribTravels) const {
    constexpr double slowestHz = 15.0;
    constexpr double fastestHz = 900.0;
    constexpr double frameSeconds = static_cast<double>(spectrumSamples) / inference::waveformRateHz;
    // A Hann window sums to half of its samples.
    constexpr double windowSum = 0.5 * static_cast<double>(spectrumSamples);
    for (std::size_t rib = 0; rib < inference::ribCount; ++rib) {
        const double rateHz = std::abs(ribTravels.back()[rib] - ribTravels.front()[rib]) / frameSeconds;
        if (rateHz <= 0.0) {
            continue;
        }
        std::array<std::complex<double>, partialsOfRib> sum{};
        for (std::size_t i = 0; i < spectrumSamples; ++i) {
            const std::complex<double> turn = std::polar(1.0, -2.0 * std::numbers::pi * ribTravels[i][rib]);
            std::complex<double> each = hannWindow()[i] * static_cast<double>(wave[i]);
            for (std::complex<double>& partial : sum) {
                each *= turn;
                partial += each;
            }
        }
        for (std::size_t partial = 0; partial < partialsOfRib; ++partial) {
            const double hertz = rateHz * static_cast<double>(partial + 1);
            if (hertz >= slowestHz && hertz <= fastestHz) {
                sums.lines[rib * partialsOfRib + partial] += 2.0 * std::norm(sum[partial]) / (windowSum * windowSum);
                sums.lineFrames[rib * partialsOfRib + partial] += 1.0;
            }
        }
    }
}

void TextureMeter::add(std::size_t bin, std::span<const float, spectrumSamples> wave,
                       std::span<const RibTravel> ribTravels) {
    Sums& sums = sums_.at(bin);
    std::ranges::transform(sums.power, powerOf(wave), sums.power.begin(), std::plus{});
    if (!ribTravels.empty()) {
        addLines(sums, wave, ribTravels);
    }
    sums.frames += 1.0;
    double squares = 0.0;
    double fourths = 0.0;
    for (const float value : wave) {
        const double square = static_cast<double>(value) * value;
        squares += square;
        fourths += square * square;
    }
    sums.squares += squares;
    sums.fourths += fourths;
    sums.logKurtoses +=
        std::log((fourths * static_cast<double>(spectrumSamples) + powerFloor) / (squares * squares + powerFloor));
    sums.samples += static_cast<double>(spectrumSamples);
    for (std::size_t kind = 0; kind < pieceSamples.size(); ++kind) {
        const std::size_t length = pieceSamples[kind];
        for (std::size_t start = 0; start + length <= wave.size(); start += length) {
            double power = 0.0;
            for (std::size_t i = start; i < start + length; ++i) {
                power += static_cast<double>(wave[i]) * wave[i];
            }
            const double logRms = 0.5 * std::log(power / static_cast<double>(length) + powerFloor);
            sums.pieces[kind] += 1.0;
            sums.logs[kind] += logRms;
            sums.logSquares[kind] += logRms * logRms;
        }
    }
}

std::vector<TextureFigures> TextureMeter::figures() const {
    std::vector<TextureFigures> result(sums_.size());
    for (std::size_t bin = 0; bin < sums_.size(); ++bin) {
        const Sums& sums = sums_[bin];
        TextureFigures& each = result[bin];
        each.frames = sums.frames;
        if (sums.frames <= 0.0) {
            continue;
        }
        for (std::size_t i = 0; i < spectrumBins; ++i) {
            each.power[i] = sums.power[i] / sums.frames;
        }
        each.meanSquare = sums.squares / sums.samples;
        const double logRms = 0.5 * std::log(each.meanSquare + powerFloor);
        for (std::size_t kind = 0; kind < pieceSamples.size(); ++kind) {
            const double mean = sums.logs[kind] / sums.pieces[kind];
            const double variance = sums.logSquares[kind] / sums.pieces[kind] - mean * mean;
            each.envelope[2 * kind] = mean - logRms;
            each.envelope[2 * kind + 1] = std::sqrt(std::max(variance, 0.0));
        }
        each.logKurtosis = sums.logKurtoses / sums.frames;
        each.lineFrames = sums.lineFrames;
        for (std::size_t i = 0; i < ribPartials; ++i) {
            each.lines[i] = sums.lines[i] / std::max(sums.lineFrames[i], 1.0);
        }
        const double kurtosis = sums.fourths / sums.samples / (each.meanSquare * each.meanSquare + 1e-12);
        each.envelope[envelopeFigures - 1] = 0.25 * std::log(kurtosis + 1e-3);
    }
    return result;
}

namespace {

// Only the middle half of a frame is used, because the filter reads samples before it, which must lie in the frame,
// too.
constexpr std::size_t middleFirst = spectrumSamples / 4;
constexpr std::size_t middleSamples = spectrumSamples / 2;
static_assert(middleFirst >= dsp::toneTaps);

constexpr double slowestRibHz = 4.0 * hertzPerBin;
constexpr double fastestRibHz = 900.0;
constexpr double lowestRibDb = -40.0;

/// Half orders from 1/2 to 1/2 beyond the last partial.
constexpr std::size_t halfOrders = 2 * partialsOfRib + 1;

/// The power at each half order of a rib: at half its rate, at its rate and so on. Whole orders are its partials, and
/// half orders hold the noise between them. Computed as `TextureMeter` does for partials alone.
std::array<double, halfOrders> orderPowers(const SpectrumFrame& frame, std::span<const RibTravel> travels,
                                           std::size_t rib) {
    constexpr double windowSum = 0.5 * static_cast<double>(spectrumSamples);
    std::array<std::complex<double>, halfOrders> sums{};
    for (std::size_t i = 0; i < spectrumSamples; ++i) {
        std::complex<double> each = hannWindow()[i] * static_cast<double>(frame.wave[i]);
        const std::complex<double> halfTurn = std::polar(1.0, -std::numbers::pi * travels[i][rib]);
        for (std::complex<double>& sum : sums) {
            each *= halfTurn;
            sum += each;
        }
    }
    std::array<double, halfOrders> powers{};
    std::ranges::transform(sums, powers.begin(), [](const std::complex<double>& sum) {
        return 2.0 * std::norm(sum) / (windowSum * windowSum);
    });
    return powers;
}

/// The power of the partials less that of the noise between them: on average 0 for a surface without ribs.
std::optional<double> ribPower(const SpectrumFrame& frame, std::span<const RibTravel> travels, std::size_t rib,
                               const std::array<double, spectrumBins>& gains) {
    constexpr double frameSeconds = static_cast<double>(spectrumSamples) / inference::waveformRateHz;
    const double rateHz = std::abs(travels.back()[rib] - travels.front()[rib]) / frameSeconds;
    if (rateHz < slowestRibHz) {
        return std::nullopt;
    }
    const auto powers = orderPowers(frame, travels, rib);
    double power = 0.0;
    for (std::size_t partial = 0; partial < partialsOfRib; ++partial) {
        const double hertz = rateHz * static_cast<double>(partial + 1);
        if (hertz > fastestRibHz) {
            break;
        }
        const double between = 0.5 * (powers[2 * partial] + powers[2 * partial + 2]);
        const auto bin = static_cast<std::size_t>(std::lround(hertz / hertzPerBin));
        power += gains[bin] * (powers[2 * partial + 1] - between);
    }
    return power;
}

}  // namespace

std::array<std::complex<double>, spectrumBins> responseOf(const dsp::ToneKernel& kernel) {
    std::vector<std::complex<double>> response(spectrumSamples);
    std::ranges::copy(kernel, response.begin());
    dsp::fourierTransform(response, dsp::Direction::forward);
    std::array<std::complex<double>, spectrumBins> bins{};
    std::ranges::copy(std::span(response).first<spectrumBins>(), bins.begin());
    return bins;
}

EngineTone::EngineTone(const model::ToneTable* tone) {
    if (tone != nullptr && !tone->gainsDb.empty()) {
        tone_.emplace(*tone);
    }
}

std::optional<dsp::ToneKernel> EngineTone::kernelAt(double speedMps, double forceNewtons) const {
    return tone_ ? std::optional(dsp::toneKernel(tone_->at(speedMps, forceNewtons))) : std::nullopt;
}

std::array<double, spectrumSamples / 2> EngineTone::filtered(const SpectrumFrame& frame) const {
    std::array<double, middleSamples> result{};
    const auto kernel = kernelAt(frame.speedMps, frame.forceNewtons);
    for (std::size_t i = 0; i < middleSamples; ++i) {
        const std::size_t at = middleFirst + i;
        if (!kernel) {
            result[i] = static_cast<double>(frame.wave[at]);
            continue;
        }
        for (std::size_t tap = 0; tap < kernel->size(); ++tap) {
            result[i] += static_cast<double>((*kernel)[tap]) * static_cast<double>(frame.wave[at - tap]);
        }
    }
    return result;
}

std::array<double, spectrumBins> EngineTone::powerGains(double speedMps, double forceNewtons) const {
    std::array<double, spectrumBins> gains{};
    const auto kernel = kernelAt(speedMps, forceNewtons);
    if (!kernel) {
        gains.fill(1.0);
        return gains;
    }
    std::ranges::transform(responseOf(*kernel), gains.begin(),
                           [](std::complex<double> each) { return std::norm(each); });
    return gains;
}

std::vector<FrameMoments> momentsOf(std::span<const SpectrumFrame> frames, const model::ToneTable* tone,
                                    std::span<const RibTravel> ribTravels) {
    const EngineTone filter(tone);
    std::vector<FrameMoments> moments;
    moments.reserve(frames.size());
    for (const SpectrumFrame& frame : frames) {
        FrameMoments each;
        for (const double value : filter.filtered(frame)) {
            const double square = value * value;
            each.meanSquare += square / static_cast<double>(middleSamples);
            each.meanFourth += square * square / static_cast<double>(middleSamples);
        }
        if (!ribTravels.empty()) {
            const auto gains = filter.powerGains(frame.speedMps, frame.forceNewtons);
            for (std::size_t rib = 0; rib < inference::ribCount; ++rib) {
                each.ribs[rib] = ribPower(frame, ribTravels.subspan(frame.first, spectrumSamples), rib, gains);
            }
        }
        moments.push_back(each);
    }
    return moments;
}

WaveFigures figuresOf(std::span<const FrameMoments> moments, std::span<const double> levels,
                      const std::function<bool(std::size_t frame)>& belongs) {
    WaveFigures figures;
    double power = 0.0;
    double squares = 0.0;
    double fourths = 0.0;
    std::array<double, inference::ribCount> ribs{};
    std::array<double, inference::ribCount> wholes{};
    for (std::size_t i = 0; i < moments.size(); ++i) {
        if (!belongs(i)) {
            continue;
        }
        const FrameMoments& each = moments[i];
        ++figures.frames;
        power += levels[i] * levels[i] * each.meanSquare;
        squares += each.meanSquare;
        fourths += each.meanFourth;
        for (std::size_t rib = 0; rib < ribs.size(); ++rib) {
            ribs[rib] += each.ribs[rib].value_or(0.0);
            wholes[rib] += each.ribs[rib] ? each.meanSquare : 0.0;
        }
    }
    if (figures.frames > 0 && squares > 0.0) {
        const auto count = static_cast<double>(figures.frames);
        figures.rmsMps2 = std::sqrt(power / count);
        figures.kurtosis = count * fourths / (squares * squares);
        for (std::size_t rib = 0; rib < ribs.size(); ++rib) {
            if (wholes[rib] > 0.0) {
                const double share = std::max(ribs[rib] / wholes[rib], 1e-9);
                figures.ribsDb[rib] = std::max(10.0 * std::log10(share), lowestRibDb);
            }
        }
    }
    return figures;
}

}  // namespace haptoflow::learning
