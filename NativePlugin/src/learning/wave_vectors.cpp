#include "learning/wave_vectors.hpp"

#include "learning/line_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace haptoflow::learning {
namespace {

/// Smaller wave numbers are rounding errors.
constexpr double zeroPerMm = 1e-9;

std::array<double, 2> turned(double x, double y, double radians) {
    const double cosine = std::cos(radians);
    const double sine = std::sin(radians);
    return {x * cosine + y * sine, y * cosine - x * sine};
}

}  // namespace

MaterialFrame MaterialFrame::across(std::span<const WaveVector> vectors) {
    MaterialFrame frame;
    std::size_t next = 0;
    for (const WaveVector& vector : vectors) {
        if ((vector.x == 0.0 && vector.y == 0.0) || next == frame.waveNumbers.size()) {
            continue;
        }
        if (next == 0) {
            frame.turnRadians = std::atan2(vector.y, vector.x);
        }
        const std::array<double, 2> across = turned(vector.x, vector.y, frame.turnRadians);
        // Ribs have no sign; the second family gets the sign that the labels use.
        const double sign = across[1] < -zeroPerMm ? -1.0 : 1.0;
        for (const double component : across) {
            frame.waveNumbers[next++] = std::abs(component) < zeroPerMm ? 0.0F : static_cast<float>(sign * component);
        }
    }
    return frame;
}

void MaterialFrame::turn(recordings::PreparedRecording& recording) const {
    if (turnRadians == 0.0) {
        return;
    }
    for (std::array<float, 3>& motion : recording.motion) {
        const std::array<double, 2> velocity = turned(motion[0], motion[1], turnRadians);
        motion[0] = static_cast<float>(velocity[0]);
        motion[1] = static_cast<float>(velocity[1]);
    }
}

namespace {

using Complex = std::complex<double>;

constexpr std::size_t harmonicCount = 6;
/// Range of a fundamental: wavelengths of 8 to 0.4 mm.
constexpr std::size_t minimumStep = 12;
constexpr std::size_t maximumStep = 250;
constexpr double minimumPerMm = 1.0 / 8.0;
constexpr double maximumPerMm = 1.0 / 0.4;
constexpr double minimumSpeedRatio = 1.25;
/// Threshold of the log likelihood ratio. Noise alone reaches 15 on none of 38 surfaces without ribs.
constexpr double sure = 20.0;
constexpr double sureBesideKnown = 24.0;
constexpr double priceOfAHarmonic = 3.0;
/// What must be left of the log likelihood ratio beside resonances, which a minute of recording makes significant.
constexpr double confirmed = 8.0;
constexpr double ownLines = 8.0;
constexpr double ownLinesShare = 0.06;
constexpr double shareOfFirst = 0.04;
constexpr double lowHarmonicsShare = 0.3;
constexpr double minimumRatio = 1.6;
/// Preference for perpendicular vectors among equal ones: threads mostly cross at right angles.
constexpr double crossingBonus = 0.2;
constexpr double crossingDegrees = 8.0;
constexpr double minimumTurnDegrees = 20.0;
constexpr double degreesPerRadian = 180.0 / std::numbers::pi;

using Harmonics = std::array<double, harmonicCount>;

double sumOf(const Harmonics& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Sum over the harmonics that a multiple of the fundamental does not have.
double sumBetween(const Harmonics& values, std::size_t divisor) {
    double sum = 0.0;
    for (std::size_t order = 1; order <= harmonicCount; ++order) {
        sum += order % divisor > 0 ? values[order - 1] : 0.0;
    }
    return sum;
}

struct Clearest {
    CyclesPerMm vector{};
    /// Orders of the harmonics inside the band.
    std::vector<std::size_t> orders;
    double score = 0.0;
};

/// Finds the best fundamental of a map of evidence.
class FundamentalSearch {
public:
    explicit FundamentalSearch(LineEvidence evidence) : evidence_(std::move(evidence)) {}

    /// `first`: the score of the first vector, if one is known.
    [[nodiscard]] std::optional<Clearest> clearest(std::span<const CyclesPerMm> known, double first) const {
        constexpr int tries = 6;
        DirectionMap scores = scoresBeside(known);
        const double enough = known.empty() ? sure : std::max(sureBesideKnown, shareOfFirst * first);
        for (int attempt = 0; attempt < tries; ++attempt) {
            const auto best = static_cast<std::size_t>(std::ranges::max_element(scores) - scores.begin());
            const double score = scores[best];
            if (score < enough) {
                return std::nullopt;
            }
            const std::size_t row = best / stepCount;
            const std::size_t place = best % stepCount;
            const std::size_t step = fundamentalOf(row, place);
            const Harmonics gains = linesOf(evidence_.all.gains, row, step);
            const Harmonics ratios = linesOf(evidence_.all.ratios, row, step);
            if (*std::ranges::max_element(ratios) >= minimumRatio && gains[0] + gains[1] >= lowHarmonicsShare * score &&
                sumOf(gainsNear(evidence_.besideResonances, row, step)) >= confirmed) {
                const double length = static_cast<double>(step) * stepPerMm;
                return Clearest{
                    {length * std::cos(angleOf(row)), length * std::sin(angleOf(row))}, audible(gains), score};
            }
            forget(scores, row, place);
        }
        return std::nullopt;
    }

private:
    static std::vector<std::size_t> audible(const Harmonics& gains) {
        std::vector<std::size_t> orders;
        for (std::size_t order = 1; order <= harmonicCount; ++order) {
            if (gains[order - 1] > 2.0 * priceOfAHarmonic) {
                orders.push_back(order);
            }
        }
        return orders.empty() ? std::vector<std::size_t>{1} : orders;
    }

    static void forget(DirectionMap& scores, std::size_t row, std::size_t place) {
        for (std::size_t r = row - std::min<std::size_t>(row, 3); r < std::min(row + 4, directionCount); ++r) {
            for (std::size_t s = place - std::min<std::size_t>(place, 5); s < std::min(place + 6, stepCount); ++s) {
                scores[r * stepCount + s] = 0.0;
            }
        }
    }

    /// For each fundamental, the sum over its harmonics.
    [[nodiscard]] DirectionMap scoresBeside(std::span<const CyclesPerMm> known) const {
        DirectionMap scores(evidence_.all.gains.size());
        for (std::size_t row = 0; row < directionCount; ++row) {
            const double weight = weightBeside(known, angleOf(row));
            for (std::size_t step = minimumStep; step < maximumStep; ++step) {
                double score = 0.0;
                for (std::size_t order = 1; order <= harmonicCount && order * step < stepCount; ++order) {
                    score += std::max(evidence_.all.gains[row * stepCount + order * step] - priceOfAHarmonic, 0.0);
                }
                scores[row * stepCount + step] = weight * score;
            }
        }
        return scores;
    }

    static double weightBeside(std::span<const CyclesPerMm> known, double angle) {
        double weight = 1.0;
        for (const CyclesPerMm& vector : known) {
            const double turned = std::fmod(std::abs(angle - std::atan2(vector[1], vector[0])), std::numbers::pi);
            const double degrees = degreesPerRadian * std::min(turned, std::numbers::pi - turned);
            const double fromCrossing = (degrees - 90.0) / crossingDegrees;
            weight *= degrees < minimumTurnDegrees ? 0.0 : 1.0 + crossingBonus * std::exp(-fromCrossing * fromCrossing);
        }
        return weight;
    }

    /// Values at the harmonics of a fundamental; 0 above the highest wave number.
    static Harmonics linesOf(const DirectionMap& values, std::size_t row, std::size_t step) {
        Harmonics lines{};
        for (std::size_t order = 1; order <= harmonicCount && order * step < stepCount; ++order) {
            lines[order - 1] = values[row * stepCount + order * step];
        }
        return lines;
    }

    /// The maximum gain near each harmonic of a fundamental that is accurate to half a step, minus a penalty.
    static Harmonics gainsNear(const DirectionMap& map, std::size_t row, std::size_t step) {
        Harmonics gains{};
        for (std::size_t order = 1; order <= harmonicCount && order * step + 1 < stepCount; ++order) {
            double largest = 0.0;
            for (std::size_t r = row - std::min<std::size_t>(row, 1); r < std::min(row + 2, directionCount); ++r) {
                const double* place = map.data() + r * stepCount + order * step;
                largest = std::max({largest, place[-1], place[0], place[1]});
            }
            gains[order - 1] = std::max(largest - priceOfAHarmonic, 0.0);
        }
        return gains;
    }

    /// The step of the fundamental. A fraction of it has the same lines, so that the largest multiple that keeps them
    /// is right; but a harmonic may be stronger than its fundamental, so that the lowest fraction with lines of its own
    /// is.
    [[nodiscard]] std::size_t fundamentalOf(std::size_t row, std::size_t step) const {
        for (const std::size_t divisor : {4U, 3U, 2U}) {
            if (static_cast<double>(divisor * step) * stepPerMm <= maximumPerMm) {
                const Harmonics gains = gainsNear(evidence_.all.gains, row, step);
                const double all = sumOf(gains);
                const bool isLost = sumOf(gainsNear(evidence_.all.gains, row, divisor * step)) <= 0.6 * all;
                if (sumBetween(gains, divisor) < std::max(ownLines, ownLinesShare * all) && !isLost) {
                    return divisor * step;
                }
            }
        }
        for (const std::size_t divisor : {4U, 3U, 2U}) {
            for (const std::size_t lower : {step / divisor, (step + divisor - 1) / divisor}) {
                if (static_cast<double>(lower) * stepPerMm >= minimumPerMm) {
                    const Harmonics gains = gainsNear(evidence_.all.gains, row, lower);
                    if (sumBetween(gains, divisor) > std::max(ownLines, ownLinesShare * sumOf(gains)) &&
                        gains[0] > ownLines) {
                        return lower;
                    }
                }
            }
        }
        return step;
    }

    LineEvidence evidence_;
};

CyclesPerMm multiple(const CyclesPerMm& vector, std::size_t order) {
    return {static_cast<double>(order) * vector[0], static_cast<double>(order) * vector[1]};
}

Complex turnAt(const PathWindow& window, std::size_t sample, const CyclesPerMm& vector) {
    return std::polar(1.0, 2.0 * std::numbers::pi * (vector[0] * window.xMm[sample] + vector[1] * window.yMm[sample]));
}

/// The sum of the lines' amplitudes over the windows that cover them.
double amplitudeOf(std::span<const PathWindow> windows, const CyclesPerMm& vector,
                   std::span<const std::size_t> orders) {
    double total = 0.0;
    for (const PathWindow& window : windows) {
        std::array<bool, harmonicCount> isCovered{};
        for (const std::size_t order : orders) {
            isCovered[order - 1] = covers(window, multiple(vector, order));
        }
        if (std::ranges::none_of(isCovered, [](bool each) { return each; })) {
            continue;
        }
        std::array<double, harmonicCount> real{};
        std::array<double, harmonicCount> imaginary{};
        const std::size_t highest = orders.back();
        for (std::size_t i = 0; i < window.wave.size(); ++i) {
            const Complex turn = turnAt(window, i, vector);
            double a = window.wave[i];
            double b = 0.0;
            for (std::size_t order = 0; order < highest; ++order) {
                const double next = a * turn.real() + b * turn.imag();
                b = b * turn.real() - a * turn.imag();
                a = next;
                real[order] += a;
                imaginary[order] += b;
            }
        }
        for (std::size_t order = 0; order < highest; ++order) {
            total += isCovered[order] ? std::hypot(real[order], imaginary[order]) : 0.0;
        }
    }
    return total;
}

/// Refines a vector to a fiftieth of the map's step by maximising the sum of the lines' amplitudes.
CyclesPerMm refined(std::span<const PathWindow> windows, CyclesPerMm vector, std::span<const std::size_t> orders) {
    constexpr int rounds = 60;
    double reach = stepPerMm;
    double best = amplitudeOf(windows, vector, orders);
    for (int round = 0; round < rounds; ++round) {
        const std::array<CyclesPerMm, 4> around{CyclesPerMm{vector[0] + reach, vector[1]},
                                                {vector[0] - reach, vector[1]},
                                                {vector[0], vector[1] + reach},
                                                {vector[0], vector[1] - reach}};
        bool isBetter = false;
        for (const CyclesPerMm& each : around) {
            const double amplitude = amplitudeOf(windows, each, orders);
            if (amplitude > best) {
                best = amplitude;
                vector = each;
                isBetter = true;
            }
        }
        if (!isBetter) {
            reach *= 0.5;
            if (reach < stepPerMm / 50.0) {
                break;
            }
        }
    }
    return vector;
}

/// Removes the lines of a vector, so that they are not attributed to another one.
void takeOut(std::span<PathWindow> windows, const CyclesPerMm& vector) {
    for (PathWindow& window : windows) {
        std::vector<Complex> rotations(window.wave.size());
        for (std::size_t i = 0; i < rotations.size(); ++i) {
            rotations[i] = turnAt(window, i, vector);
        }
        std::vector<Complex> line(rotations.size(), 1.0);
        for (std::size_t order = 1; order <= takenHarmonics; ++order) {
            Complex sum = 0.0;
            for (std::size_t i = 0; i < line.size(); ++i) {
                line[i] *= rotations[i];
                sum += window.wave[i] * std::conj(line[i]);
            }
            if (covers(window, multiple(vector, order))) {
                for (std::size_t i = 0; i < line.size(); ++i) {
                    window.wave[i] -= window.hann[i] * 2.0 * (sum / window.hannSum * line[i]).real();
                }
            }
        }
    }
}

bool speedChanges(std::span<const PathWindow> windows) {
    std::vector<double> speeds;
    for (const PathWindow& window : windows) {
        speeds.push_back(window.speedMmps);
    }
    std::ranges::sort(speeds);
    return speeds[speeds.size() * 9 / 10] >= minimumSpeedRatio * speeds[speeds.size() / 10];
}

/// Chooses between a vector and its opposite, which describe the same ribs: the larger component is positive, to five
/// digits.
WaveVector upward(const CyclesPerMm& vector) {
    const double larger = std::abs(vector[0]) >= std::abs(vector[1]) ? vector[0] : vector[1];
    const double sign = larger > 0.0 ? 1.0 : -1.0;
    const auto rounded = [&](double value) { return std::round(1e5 * sign * value) / 1e5 + 0.0; };
    return {.x = rounded(vector[0]), .y = rounded(vector[1])};
}

}  // namespace

std::vector<WaveVector> findWaveVectors(const recordings::PreparedRecording& recording, const Sliding& sliding) {
    std::vector<PathWindow> windows = pathWindows(recording, sliding);
    if (windows.size() < minimumWindows || !speedChanges(windows)) {
        return {};
    }
    std::vector<CyclesPerMm> found;
    double first = 0.0;
    while (found.size() < inference::ribCount) {
        const FundamentalSearch search(lineEvidence(windows, found));
        const std::optional<Clearest> next = search.clearest(found, first);
        if (!next) {
            break;
        }
        first = found.empty() ? next->score : first;
        found.push_back(refined(windows, next->vector, next->orders));
        takeOut(windows, found.back());
    }
    std::vector<WaveVector> result;
    std::ranges::transform(found, std::back_inserter(result), upward);
    return result;
}

std::vector<WaveVector> findWaveVectors(std::span<const float> wave, std::span<const float> velocitiesMps) {
    recordings::PreparedRecording recording;
    recording.wave.assign(wave.begin(), wave.end());
    Sliding sliding;
    sliding.before.push_back(0);
    for (std::size_t i = 0; i < wave.size(); ++i) {
        recording.motion.push_back({velocitiesMps[2 * i], velocitiesMps[2 * i + 1], 0.0F});
        const bool isUsable = std::isfinite(wave[i]) && std::isfinite(recording.speedMps(i));
        const bool isSliding = isUsable && recording.speedMps(i) >= minimumSlidingMps;
        recording.isUsable.push_back(isUsable ? 1 : 0);
        sliding.isSliding.push_back(isSliding ? 1 : 0);
        sliding.before.push_back(sliding.before.back() + (isSliding ? 1U : 0U));
    }
    return findWaveVectors(recording, sliding);
}

}  // namespace haptoflow::learning
