#include "learning/frame_figures.hpp"

#include "dsp/fourier_transform.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace haptoflow::learning {
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
        const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(spectrumSamples);
        std::complex<double> each = (0.5 - 0.5 * std::cos(turn)) * static_cast<double>(frame.wave[i]);
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
