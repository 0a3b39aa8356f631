#include "learning/wave_vectors.hpp"

#include "learning/linear_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

namespace haptoflow::learning {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t shortestWindow = 160;
constexpr std::size_t longestWindow = 800;
constexpr double wantedWayMm = 25.0;
constexpr std::size_t predictorOrder = 10;
constexpr std::size_t mostWindows = 160;
constexpr double sampleSeconds = 1.0 / 2000.0;
constexpr double millimetresPerMetre = 1000.0;
/// A window whose way bends more, or is shorter, says little about a direction.
constexpr double straightest = 0.96;
constexpr double shortestWayMm = 4.0;
constexpr double lowestCycles = 0.1;
constexpr double highestCycles = 4.0;
constexpr double cyclesStep = 0.01;
constexpr int directions = 60;
constexpr double slowestRateHz = 15.0;
constexpr double fastestRateHz = 800.0;
constexpr std::size_t fewestWindows = 6;
/// One window in so many must hear a vector: strokes go in all directions, and across some ribs only.
constexpr std::size_t hearingShare = 5;
/// Times the power of noise of that spectrum.
constexpr double leastProminence = 2.6;
/// Over what stands around it in the way's spectrum: a resonance is wide, a rib's line is not.
constexpr double leastContrast = 4.0;
constexpr double smallestSpeedRatio = 1.25;

/// Windowed and whitened, with the tip's way in millimetres from the window's middle.
struct Window {
    std::vector<double> wave;
    std::vector<double> x;
    std::vector<double> y;
    double directionX = 0.0;
    double directionY = 0.0;
    double wayMm = 0.0;
    double speedMmps = 0.0;
    /// What noise gives |sum|^2.
    double noisePower = 0.0;
};

/// Linear prediction takes what the surface and the tool colour all of it, and leaves lines.
std::vector<double> whitened(const Sliding& sliding, std::span<const float> wave) {
    std::vector<double> correlation(predictorOrder + 1);
    for (std::size_t i = predictorOrder; i < wave.size(); ++i) {
        if (sliding.isSliding[i] != 0) {
            for (std::size_t lag = 0; lag <= predictorOrder; ++lag) {
                correlation[lag] += static_cast<double>(wave[i]) * wave[i - lag];
            }
        }
    }
    SymmetricMatrix matrix(predictorOrder);
    std::vector<double> right(predictorOrder);
    for (std::size_t i = 0; i < predictorOrder; ++i) {
        right[i] = correlation[i + 1];
        for (std::size_t j = 0; j < predictorOrder; ++j) {
            matrix.at(i, j) = correlation[i > j ? i - j : j - i];
        }
        matrix.at(i, i) += 1e-3 * correlation[0] + 1e-12;
    }
    const std::vector<double> taps = solvePositive(std::move(matrix), std::move(right));
    std::vector<double> result(wave.size());
    for (std::size_t i = predictorOrder; i < wave.size(); ++i) {
        double predicted = 0.0;
        for (std::size_t lag = 1; lag <= predictorOrder; ++lag) {
            predicted += taps[lag - 1] * wave[i - lag];
        }
        result[i] = wave[i] - predicted;
    }
    return result;
}

double hannAt(std::size_t sample, std::size_t length) {
    return 0.5 -
           0.5 * std::cos(2.0 * std::numbers::pi * (static_cast<double>(sample) + 0.5) / static_cast<double>(length));
}

/// A way of so many millimetres holds many ribs, and a tracker's error over it is less than one.
std::size_t windowLength(double speedMps) {
    const double samples = wantedWayMm / (millimetresPerMetre * sampleSeconds * std::max(speedMps, slowestSlidingMps));
    return static_cast<std::size_t>(
        std::clamp(samples, static_cast<double>(shortestWindow), static_cast<double>(longestWindow)));
}

std::optional<Window> windowAt(const PreparedRecording& recording, std::span<const double> wave, std::size_t start,
                               std::size_t length) {
    Window window;
    double x = 0.0;
    double y = 0.0;
    double way = 0.0;
    double energy = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < length; ++i) {
        const double hann = hannAt(i, length);
        const auto& motion = recording.motion[start + i];
        window.wave.push_back(hann * wave[start + i]);
        window.x.push_back(x);
        window.y.push_back(y);
        x += millimetresPerMetre * sampleSeconds * motion[0];
        y += millimetresPerMetre * sampleSeconds * motion[1];
        way += millimetresPerMetre * sampleSeconds * std::hypot(motion[0], motion[1]);
        energy += wave[start + i] * wave[start + i] / static_cast<double>(length);
        squares += hann * hann;
    }
    const double straight = std::hypot(x, y);
    if (straight < straightest * way || way < shortestWayMm || !(energy > 0.0)) {
        return std::nullopt;
    }
    window.directionX = x / straight;
    window.directionY = y / straight;
    window.wayMm = way;
    window.speedMmps = way / (static_cast<double>(length) * sampleSeconds);
    window.noisePower = energy * squares;
    return window;
}

std::vector<Window> windowsOf(const PreparedRecording& recording, const Sliding& sliding,
                              std::span<const float> unitWave) {
    const std::vector<double> wave = whitened(sliding, unitWave);
    std::vector<Window> windows;
    for (std::size_t start = 0; start + shortestWindow <= wave.size();) {
        const std::size_t length = windowLength(recording.speedMps(start));
        if (sliding.holds(start, length)) {
            if (std::optional<Window> window = windowAt(recording, wave, start, length)) {
                windows.push_back(std::move(*window));
            }
            start += length / 2;
        } else {
            start += shortestWindow / 2;
        }
    }
    if (windows.size() > mostWindows) {
        std::vector<Window> kept;
        for (std::size_t i = 0; i < mostWindows; ++i) {
            kept.push_back(std::move(windows[i * windows.size() / mostWindows]));
        }
        windows = std::move(kept);
    }
    return windows;
}

double powerAt(const Window& window, double kx, double ky) {
    Complex sum = 0.0;
    for (std::size_t i = 0; i < window.wave.size(); ++i) {
        sum += window.wave[i] * std::polar(1.0, -2.0 * std::numbers::pi * (kx * window.x[i] + ky * window.y[i]));
    }
    return std::norm(sum) / window.noisePower;
}

bool hears(const Window& window, double cyclesAlong) {
    const double rate = std::abs(cyclesAlong) * window.speedMmps;
    return rate >= slowestRateHz && rate <= fastestRateHz;
}

/// One window's power by cycles per millimetre along its own direction.
std::vector<double> spectrumAlong(const Window& window) {
    const auto count = static_cast<std::size_t>(highestCycles / cyclesStep) + 2;
    std::vector<double> power(count);
    std::vector<double> along(window.wave.size());
    for (std::size_t i = 0; i < along.size(); ++i) {
        along[i] = window.x[i] * window.directionX + window.y[i] * window.directionY;
    }
    std::vector<Complex> turn(along.size());
    std::vector<Complex> step(along.size());
    for (std::size_t i = 0; i < along.size(); ++i) {
        turn[i] = window.wave[i];
        step[i] = std::polar(1.0, -2.0 * std::numbers::pi * cyclesStep * along[i]);
    }
    for (double& each : power) {
        Complex sum = 0.0;
        for (std::size_t i = 0; i < turn.size(); ++i) {
            sum += turn[i];
            turn[i] *= step[i];
        }
        each = std::norm(sum) / window.noisePower;
    }
    return power;
}

class Search {
public:
    explicit Search(std::vector<Window> windows) : windows_(std::move(windows)) {
        std::vector<double> ways;
        for (const Window& window : windows_) {
            ways.push_back(window.wayMm);
        }
        if (!ways.empty()) {
            std::ranges::nth_element(ways, ways.begin() + static_cast<std::ptrdiff_t>(ways.size() / 2));
            medianWayMm_ = ways[ways.size() / 2];
        }
    }

    std::vector<WaveVector> find() {
        std::vector<WaveVector> found;
        if (windows_.size() < fewestWindows || !speedChanges()) {
            return found;
        }
        scan();
        while (found.size() < inference::ribCount) {
            std::optional<WaveVector> next = strongest(found);
            if (!next) {
                break;
            }
            found.push_back(*next);
            takeOut(*next);
            scan();
        }
        return found;
    }

private:
    struct Point {
        double kx = 0.0;
        double ky = 0.0;
        double prominence = 0.0;
        double contrast = 0.0;
    };

    [[nodiscard]] bool speedChanges() const {
        std::vector<double> speeds;
        for (const Window& window : windows_) {
            speeds.push_back(window.speedMmps);
        }
        std::ranges::sort(speeds);
        return speeds[speeds.size() * 9 / 10] >= smallestSpeedRatio * speeds[speeds.size() / 10];
    }

    /// Mean over the windows that can hear the vector; zero where too few can.
    [[nodiscard]] double onGrid(double kx, double ky) const {
        double sum = 0.0;
        std::size_t count = 0;
        for (std::size_t w = 0; w < windows_.size(); ++w) {
            const double along = std::abs(kx * windows_[w].directionX + ky * windows_[w].directionY);
            if (hears(windows_[w], along)) {
                const auto index = static_cast<std::size_t>(std::lround(along / cyclesStep));
                if (index < spectra_[w].size()) {
                    sum += limited(spectra_[w][index]);
                    ++count;
                }
            }
        }
        return count >= std::max(fewestWindows, windows_.size() / hearingShare) ? sum / static_cast<double>(count)
                                                                                : 0.0;
    }

    [[nodiscard]] double exactly(double kx, double ky) const {
        double sum = 0.0;
        std::size_t count = 0;
        for (const Window& window : windows_) {
            if (hears(window, kx * window.directionX + ky * window.directionY)) {
                sum += limited(powerAt(window, kx, ky));
                ++count;
            }
        }
        return count >= std::max(fewestWindows, windows_.size() / hearingShare) ? sum / static_cast<double>(count)
                                                                                : 0.0;
    }

    /// One loud window must not stand for many.
    static double limited(double power) {
        constexpr double largest = 40.0;
        return std::min(power, largest);
    }

    /// What the ribs that were found leave of each window, so that they do not pass for others in strokes that cross
    /// both alike.
    void takeOut(const WaveVector& vector) {
        constexpr int harmonics = 8;
        for (Window& window : windows_) {
            for (int harmonic = 1; harmonic <= harmonics; ++harmonic) {
                const double kx = harmonic * vector.x;
                const double ky = harmonic * vector.y;
                if (!hears(window, kx * window.directionX + ky * window.directionY)) {
                    continue;
                }
                std::vector<Complex> line(window.wave.size());
                Complex sum = 0.0;
                double weight = 0.0;
                for (std::size_t i = 0; i < line.size(); ++i) {
                    line[i] = std::polar(1.0, 2.0 * std::numbers::pi * (kx * window.x[i] + ky * window.y[i]));
                    sum += window.wave[i] * std::conj(line[i]);
                    weight += hannAt(i, line.size());
                }
                for (std::size_t i = 0; i < line.size(); ++i) {
                    window.wave[i] -= hannAt(i, line.size()) * 2.0 * (sum / weight * line[i]).real();
                }
            }
        }
    }

    void scan() {
        spectra_.clear();
        points_.clear();
        for (const Window& window : windows_) {
            spectra_.push_back(spectrumAlong(window));
        }
        for (int direction = 0; direction < directions; ++direction) {
            const double angle = std::numbers::pi * static_cast<double>(direction) / static_cast<double>(directions);
            for (double cycles = lowestCycles; cycles < highestCycles; cycles += cyclesStep) {
                const Point point{cycles * std::cos(angle), cycles * std::sin(angle), 0.0, 0.0};
                const double prominence = onGrid(point.kx, point.ky);
                if (prominence > 0.7 * leastProminence) {
                    points_.push_back({point.kx, point.ky, prominence, 0.0});
                }
            }
        }
        std::ranges::sort(points_, {},
                          [](const Point& each) { return std::tuple(-each.prominence, each.kx, each.ky); });
    }

    static bool isMultiple(const Point& point, const WaveVector& of) {
        const double length = of.cyclesPerMillimetre();
        const double along = (point.kx * of.x + point.ky * of.y) / length;
        const double across = std::abs(point.kx * of.y - point.ky * of.x) / length;
        const double nearest = std::max(1.0, std::round(std::abs(along) / length));
        const bool isHalf = std::abs(std::abs(along) / length - 0.5) < 0.06;
        return across < 0.2 * std::abs(along) + 0.05 &&
               (isHalf || std::abs(std::abs(along) / length - nearest) < 0.08 * nearest);
    }

    [[nodiscard]] Point refined(Point point) const {
        double step = 0.5 * cyclesStep;
        point.prominence = exactly(point.kx, point.ky);
        for (int round = 0; round < 40 && step > 2e-4; ++round) {
            Point best = point;
            for (const auto& [dx, dy] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
                Point next{point.kx + step * dx, point.ky + step * dy, 0.0, 0.0};
                next.prominence = exactly(next.kx, next.ky);
                if (next.prominence > best.prominence) {
                    best = next;
                }
            }
            if (best.prominence <= point.prominence) {
                step *= 0.5;
            } else {
                point = best;
            }
        }
        return point;
    }

    /// Over the median of vectors of the same direction beside it, clear of what a window resolves.
    [[nodiscard]] double contrastOf(const Point& point) const {
        constexpr int steps = 16;
        constexpr double mainLobe = 2.5;
        constexpr double reach = 0.4;
        const double length = std::hypot(point.kx, point.ky);
        const double nearest = std::max(0.06 * length, mainLobe / medianWayMm_);
        std::vector<double> around;
        for (int i = 0; i < steps; ++i) {
            const double offset = nearest + reach * length * static_cast<double>(i) / static_cast<double>(steps);
            for (const double sign : {-1.0, 1.0}) {
                const double scale = 1.0 + sign * offset / length;
                const double each = scale > 0.0 ? onGrid(scale * point.kx, scale * point.ky) : 0.0;
                if (each > 0.0) {
                    around.push_back(each);
                }
            }
        }
        if (around.empty()) {
            return 0.0;
        }
        std::ranges::nth_element(around, around.begin() + static_cast<std::ptrdiff_t>(around.size() / 2));
        return point.prominence / around[around.size() / 2];
    }

    [[nodiscard]] std::optional<WaveVector> strongest(const std::vector<WaveVector>& found) const {
        constexpr std::size_t mostTries = 8;
        std::vector<Point> tried;
        for (const Point& point : points_) {
            const bool isKnown =
                std::ranges::any_of(found, [&](const WaveVector& each) { return isMultiple(point, each); });
            if (isKnown) {
                continue;
            }
            const bool isTried = std::ranges::any_of(tried, [&](const Point& each) {
                return std::hypot(point.kx - each.kx, point.ky - each.ky) < 0.1 * std::hypot(each.kx, each.ky);
            });
            if (isTried) {
                continue;
            }
            Point best = refined(point);
            best.contrast = contrastOf(best);
            if (best.prominence >= leastProminence && best.contrast >= leastContrast) {
                return fundamentalOf(best);
            }
            tried.push_back(point);
            if (tried.size() == mostTries) {
                break;
            }
        }
        return std::nullopt;
    }

    /// A harmonic may be stronger than what it belongs to.
    [[nodiscard]] WaveVector fundamentalOf(const Point& harmonic) const {
        for (const double divisor : {4.0, 3.0, 2.0}) {
            const Point lower = refined({harmonic.kx / divisor, harmonic.ky / divisor, 0.0, 0.0});
            const double ratio = std::hypot(harmonic.kx, harmonic.ky) / std::hypot(lower.kx, lower.ky);
            if (lower.prominence >= leastProminence && std::abs(ratio - divisor) < 0.05 * divisor &&
                contrastOf(lower) >= 0.7 * leastContrast) {
                return vectorOf(lower);
            }
        }
        return vectorOf(harmonic);
    }

    static WaveVector vectorOf(const Point& point) {
        const bool isFlipped = point.kx < 0.0 || (point.kx == 0.0 && point.ky < 0.0);
        const double sign = isFlipped ? -1.0 : 1.0;
        return {.x = sign * point.kx, .y = sign * point.ky, .prominence = point.prominence};
    }

    std::vector<Window> windows_;
    std::vector<std::vector<double>> spectra_;
    std::vector<Point> points_;
    double medianWayMm_ = 1.0;
};

}  // namespace

double WaveVector::cyclesPerMillimetre() const {
    return std::hypot(x, y);
}

std::vector<WaveVector> findWaveVectors(const PreparedRecording& recording, const Sliding& sliding,
                                        std::span<const float> unitWave) {
    return Search(windowsOf(recording, sliding, unitWave)).find();
}

}  // namespace haptoflow::learning
