#include "learning/line_background.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace haptoflow::learning {
namespace {

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

double medianOf(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

}  // namespace

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
            logs[place] = pool.empty() ? 0.0 : std::log(std::max(medianOf(pool) / medianOfNoise, smallestPower));
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

}  // namespace haptoflow::learning
