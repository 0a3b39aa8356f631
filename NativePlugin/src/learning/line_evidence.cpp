#include "learning/line_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <set>

namespace haptoflow::learning {
namespace {

/// The band in which lines are sought: between the hand's own motion and the end of a recording's band.
constexpr double lowestLineHz = 15.0;
constexpr double highestLineHz = 800.0;
/// Of the power of noise at one frequency, which is chi-squared with two degrees of freedom, over its mean.
constexpr double medianOfNoise = std::numbers::ln2;

constexpr std::size_t places = 41;
constexpr double reachHz = 6.0;
constexpr double relativeReach = 0.12;
constexpr std::size_t fewestSimilar = 12;
constexpr std::size_t mostSimilar = 40;
constexpr std::size_t similarShare = 5;
constexpr double smallestPower = 1e-12;

/// Evenly spaced on a logarithmic scale.
double placeHz(std::size_t place) {
    return lowestLineHz *
           std::pow(highestLineHz / lowestLineHz, static_cast<double>(place) / static_cast<double>(places - 1));
}

/// The windows of the most similar speeds, itself included.
std::vector<std::size_t> similarWindows(std::span<const PathWindow> windows, std::size_t window) {
    std::vector<std::size_t> order(windows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t other) {
        return std::abs(std::log(windows[other].speedMmps / windows[window].speedMmps));
    });
    order.resize(std::min(order.size(), std::clamp(windows.size() / similarShare, fewestSimilar, mostSimilar)));
    return order;
}

/// Divides the power of each window by the mean power of noise at its frequency and speed, estimated from the windows
/// of the most similar speeds: resonances of surface and tool stay at their frequency while the direction changes, and
/// ribs do not. The median over windows and neighbouring frequencies ignores lines.
///
/// `spectra`: a row for each window, whose column c is the wave number c * `cyclesPerMm`.
void divideByBackground(std::span<const PathWindow> windows, double cyclesPerMm,
                        std::vector<std::vector<double>>& spectra) {
    const std::vector<std::vector<double>> original = spectra;
    for (std::size_t w = 0; w < windows.size(); ++w) {
        const std::vector<std::size_t> similar = similarWindows(windows, w);
        std::array<double, places> logs{};
        std::vector<double> pool;
        for (std::size_t place = 0; place < places; ++place) {
            const double hertz = placeHz(place);
            const double reach = std::max(reachHz, relativeReach * hertz);
            pool.clear();
            for (const std::size_t other : similar) {
                const double hertzPerColumn = cyclesPerMm * windows[other].speedMmps;
                const double from = std::max(hertz - reach, lowestLineHz) / hertzPerColumn;
                const double to = std::min(hertz + reach, highestLineHz) / hertzPerColumn;
                const std::vector<double>& power = original[other];
                for (auto column = static_cast<std::size_t>(std::ceil(from));
                     column < power.size() && static_cast<double>(column) <= to; ++column) {
                    pool.push_back(power[column]);
                }
            }
            logs[place] =
                pool.empty() ? 0.0 : std::log(std::max(recordings::upperMedian(pool) / medianOfNoise, smallestPower));
        }
        const double hertzPerColumn = cyclesPerMm * windows[w].speedMmps;
        const double placesPerNat = static_cast<double>(places - 1) / std::log(highestLineHz / lowestLineHz);
        for (std::size_t column = 0; column < spectra[w].size(); ++column) {
            const double hertz = std::clamp(static_cast<double>(column) * hertzPerColumn, lowestLineHz, highestLineHz);
            const double place = placesPerNat * std::log(hertz / lowestLineHz);
            const auto below = std::min(static_cast<std::size_t>(place), places - 2);
            spectra[w][column] *=
                std::exp(-std::lerp(logs[below], logs[below + 1], place - static_cast<double>(below)));
        }
    }
}

constexpr double minimumAlongPerMm = 0.08;
/// At least one window in this many must cover a vector: strokes go in all directions, and only some cross given ribs.
constexpr std::size_t coveringShare = 5;
/// In units of the mean noise power.
constexpr double maximumPower = 30.0;
constexpr double minimumPower = 1e-3;
constexpr std::size_t sectorCount = 12;
/// Strokes in more sectors count as a hand's. A machine that scans along multiples of 45 degrees has 4.
constexpr std::size_t mostDirectionsOfAMachine = 4;
constexpr std::size_t neighbours = 41;
/// Half overlapping windows give 0.6 of the information of separate ones.
constexpr double independentShare = 0.6;
/// Half a window's main lobe is 1.6 of its bins; slightly uneven ribs spread their higher harmonics.
constexpr double lobeBins = 1.6;
constexpr double widerByOrder = 0.1;

bool isInBand(double cyclesPerMm, const PathWindow& window) {
    const double hertz = cyclesPerMm * window.speedMmps;
    return hertz >= lowestLineHz && hertz <= highestLineHz;
}

/// Sums a wave over the samples for increasing wave numbers; in single precision, whose error is far below the noise.
class TurningWave {
public:
    explicit TurningWave(const PathWindow& window) {
        // Padded with zeros, so that whole lanes are summed.
        const std::size_t padded = (window.wave.size() + lanes - 1) / lanes * lanes;
        for (std::vector<float>* each : {&real_, &imaginary_, &stepReal_, &stepImaginary_}) {
            each->resize(padded);
        }
        for (std::size_t i = 0; i < window.wave.size(); ++i) {
            const double along = window.xMm[i] * window.directionX + window.yMm[i] * window.directionY;
            const double turn = -2.0 * std::numbers::pi * stepPerMm * along;
            real_[i] = static_cast<float>(window.wave[i]);
            stepReal_[i] = static_cast<float>(std::cos(turn));
            stepImaginary_[i] = static_cast<float>(std::sin(turn));
        }
    }

    /// Power at the present wave number; advances to the next one.
    double next() {
        std::array<float, lanes> realSums{};
        std::array<float, lanes> imaginarySums{};
        for (std::size_t first = 0; first < real_.size(); first += lanes) {
            float* real = real_.data() + first;
            float* imaginary = imaginary_.data() + first;
            const float* stepReal = stepReal_.data() + first;
            const float* stepImaginary = stepImaginary_.data() + first;
            for (std::size_t i = 0; i < lanes; ++i) {
                const float a = real[i];
                const float b = imaginary[i];
                realSums[i] += a;
                imaginarySums[i] += b;
                real[i] = a * stepReal[i] - b * stepImaginary[i];
                imaginary[i] = a * stepImaginary[i] + b * stepReal[i];
            }
        }
        double realSum = 0.0;
        double imaginarySum = 0.0;
        for (std::size_t i = 0; i < lanes; ++i) {
            realSum += realSums[i];
            imaginarySum += imaginarySums[i];
        }
        return realSum * realSum + imaginarySum * imaginarySum;
    }

private:
    static constexpr std::size_t lanes = 8;

    std::vector<float> real_;
    std::vector<float> imaginary_;
    std::vector<float> stepReal_;
    std::vector<float> stepImaginary_;
};

double medianOf(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return values.size() % 2 == 1 ? *middle : 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

using Spectra = std::vector<std::vector<double>>;

/// Scales the power of each window so that its noise has the mean 1, and limits it, so that one loud window does not
/// dominate.
void normalise(Spectra& spectra, std::span<const PathWindow> windows) {
    for (std::size_t w = 0; w < windows.size(); ++w) {
        std::vector<double> inBand;
        for (std::size_t step = 0; step < stepCount; ++step) {
            if (isInBand(static_cast<double>(step) * stepPerMm, windows[w])) {
                inBand.push_back(spectra[w][step]);
            }
        }
        const double usual = inBand.empty() ? 1.0 : medianOf(std::move(inBand)) / medianOfNoise;
        for (double& each : spectra[w]) {
            each = std::min(usual > 0.0 ? each / usual : each, maximumPower);
        }
    }
}

/// Power by wave number along each window's own direction, with 1 as the mean of the noise.
Spectra spectraOf(std::span<const PathWindow> windows) {
    Spectra spectra;
    for (const PathWindow& window : windows) {
        TurningWave wave(window);
        std::ranges::generate(spectra.emplace_back(stepCount), [&] { return wave.next(); });
    }
    normalise(spectra, windows);
    return spectra;
}

/// Marks wave numbers inside the band that no harmonic of a known vector explains.
std::vector<std::uint8_t> coveredSteps(const PathWindow& window, std::span<const CyclesPerMm> known) {
    std::vector<std::uint8_t> heard(stepCount);
    for (std::size_t step = 0; step < stepCount; ++step) {
        const double place = static_cast<double>(step) * stepPerMm;
        bool isCovered = isInBand(place, window);
        for (const CyclesPerMm& vector : known) {
            const double fundamental = std::abs(window.directionX * vector[0] + window.directionY * vector[1]);
            for (std::size_t order = 0; order <= takenHarmonics; ++order) {
                const double reach = (1.0 + widerByOrder * static_cast<double>(order)) * lobeBins / window.pathMm;
                isCovered = isCovered && std::abs(place - static_cast<double>(order) * fundamental) >= reach;
            }
        }
        heard[step] = isCovered ? 1 : 0;
    }
    return heard;
}

/// The windows of one sector: for each wave number, the sum of the powers of those that cover it, and how many do.
struct SectorRow {
    std::array<double, stepCount> sums{};
    std::array<double, stepCount> counts{};
};

/// The sector of a window's direction. Multiples of 45 degrees lie in the middle of a sector: machines scan along them.
std::size_t sectorOf(const PathWindow& window) {
    const double turn = std::atan2(window.directionY, window.directionX) / std::numbers::pi + 0.5 / sectorCount + 2.0;
    return static_cast<std::size_t>(std::fmod(turn, 1.0) * sectorCount) % sectorCount;
}

/// The sector of each window if strokes have few directions, as a machine's, because a wrong vector then shares the
/// ribs' lines in one or two directions. Else 0 for every window, because the mean of all windows shows weak lines
/// best.
std::vector<std::size_t> sectorsOf(std::span<const PathWindow> windows) {
    std::vector<std::size_t> sectors(windows.size());
    std::ranges::transform(windows, sectors.begin(), sectorOf);
    const std::set<std::size_t> distinct(sectors.begin(), sectors.end());
    if (distinct.size() > mostDirectionsOfAMachine) {
        std::ranges::fill(sectors, 0);
    }
    return sectors;
}

/// How far the logarithm of a mean of `count` exponentially distributed powers lies below that of their expectation, in
/// the mean: log(n) - digamma(n).
double biasOfLog(double count) {
    return 0.5 / count + 1.0 / (12.0 * count * count);
}

/// One direction of the map. The mean power at a wave number is arithmetic within a sector and geometric across
/// sectors, so that a line that only some directions show counts little.
struct DirectionRow {
    std::array<SectorRow, sectorCount> sectors{};

    [[nodiscard]] double count(std::size_t step) const {
        double total = 0.0;
        for (const SectorRow& sector : sectors) {
            total += sector.counts[step];
        }
        return total;
    }

    /// all: `count` at this step.
    [[nodiscard]] double mean(std::size_t step, double all) const {
        double logarithm = 0.0;
        for (const SectorRow& sector : sectors) {
            const double windows = sector.counts[step];
            if (windows == all) {
                return sector.sums[step] / all;
            }
            if (windows > 0.0) {
                const double power = std::max(sector.sums[step] / windows, minimumPower);
                logarithm += windows * (std::log(power) + biasOfLog(windows));
            }
        }
        return std::exp(logarithm / all);
    }
};

/// Background of each value: the median of 41 neighbours, with repeated ends.
std::vector<double> mediansAround(std::span<const double> values) {
    constexpr std::ptrdiff_t reach = neighbours / 2;
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    std::vector<double> medians(values.size());
    std::array<double, neighbours> around{};
    for (std::ptrdiff_t i = 0; i <= last; ++i) {
        for (std::ptrdiff_t offset = -reach; offset <= reach; ++offset) {
            around[static_cast<std::size_t>(offset + reach)] =
                values[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i + offset, 0, last))];
        }
        std::ranges::nth_element(around, around.begin() + reach);
        medians[static_cast<std::size_t>(i)] = around[reach];
    }
    return medians;
}

/// `heard`: for each window, the wave numbers that count.
LineMap mapOf(std::span<const PathWindow> windows, const Spectra& spectra,
              const std::vector<std::vector<std::uint8_t>>& heard) {
    const auto fewest = static_cast<double>(std::max(minimumWindows, windows.size() / coveringShare));
    const std::vector<std::size_t> sectorOfWindow = sectorsOf(windows);
    LineMap map{DirectionMap(directionCount * stepCount), DirectionMap(directionCount * stepCount)};
    for (std::size_t direction = 0; direction < directionCount; ++direction) {
        const double cosine = std::cos(angleOf(direction));
        const double sine = std::sin(angleOf(direction));
        DirectionRow row;
        for (std::size_t w = 0; w < windows.size(); ++w) {
            const double share = std::abs(windows[w].directionX * cosine + windows[w].directionY * sine);
            for (std::size_t step = 0; step < stepCount; ++step) {
                const double along = share * static_cast<double>(step);
                const auto column = static_cast<std::size_t>(std::floor(along + 0.5));
                if (along * stepPerMm > minimumAlongPerMm && heard[w][column] != 0) {
                    SectorRow& sector = row.sectors[sectorOfWindow[w]];
                    sector.sums[step] += spectra[w][column];
                    sector.counts[step] += 1.0;
                }
            }
        }
        std::array<double, stepCount> counts{};
        std::array<double, stepCount> means{};
        for (std::size_t step = 0; step < stepCount; ++step) {
            counts[step] = row.count(step);
            means[step] = counts[step] >= fewest ? row.mean(step, counts[step]) : 1.0;
        }
        const std::vector<double> around = mediansAround(means);
        for (std::size_t step = 0; step < stepCount; ++step) {
            const double ratio = counts[step] >= fewest ? means[step] / std::max(around[step], 1.0) : 0.0;
            // The likelihood ratio for exponentially distributed powers of mean `ratio` instead of 1, at its most
            // likely value.
            const double gain = ratio > 1.0 ? independentShare * counts[step] * (ratio - 1.0 - std::log(ratio)) : 0.0;
            map.ratios[direction * stepCount + step] = ratio;
            map.gains[direction * stepCount + step] = gain;
        }
    }
    return map;
}

}  // namespace

double angleOf(std::size_t direction) {
    return std::numbers::pi * static_cast<double>(direction) / static_cast<double>(directionCount);
}

bool covers(const PathWindow& window, const CyclesPerMm& vector) {
    return isInBand(std::abs(vector[0] * window.directionX + vector[1] * window.directionY), window);
}

LineEvidence lineEvidence(std::span<const PathWindow> windows, std::span<const CyclesPerMm> known) {
    std::vector<std::vector<std::uint8_t>> heard;
    for (const PathWindow& window : windows) {
        heard.push_back(coveredSteps(window, known));
    }
    Spectra spectra = spectraOf(windows);
    LineEvidence evidence{.all = mapOf(windows, spectra, heard), .besideResonances = {}};
    divideByBackground(windows, stepPerMm, spectra);
    normalise(spectra, windows);
    evidence.besideResonances = mapOf(windows, spectra, heard).gains;
    return evidence;
}

}  // namespace haptoflow::learning
