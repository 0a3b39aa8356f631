#include "recordings/frame_statistics.hpp"

#include <algorithm>
#include <numeric>

namespace haptoflow::recordings {
namespace {

constexpr std::size_t bins = ShortTimeSpectrum::bins;

}  // namespace

std::vector<double> meanSquaresOf(const SpectrumCells& power, const Frames& frames) {
    std::vector<double> levels(frames.size());
    std::ranges::transform(frames, levels.begin(), [&](std::size_t frame) {
        return ShortTimeSpectrum::meanSquare(std::span(power).subspan(frame * bins, bins));
    });
    return levels;
}

std::vector<double> meanSpectrum(const SpectrumCells& power, std::span<const std::size_t> frames) {
    std::vector<double> mean(bins);
    for (const std::size_t frame : frames) {
        for (std::size_t bin = 0; bin < bins; ++bin) {
            mean[bin] += power[frame * bins + bin] / static_cast<double>(frames.size());
        }
    }
    return mean;
}

std::vector<double> smoothed(std::span<const double> spectrum) {
    constexpr std::size_t reach = 2;
    std::vector<double> result(spectrum.size());
    for (std::size_t bin = 0; bin < spectrum.size(); ++bin) {
        const std::size_t first = bin - std::min(bin, reach);
        result[bin] = meanOf(spectrum.subspan(first, std::min(bin + reach + 1, spectrum.size()) - first));
    }
    return result;
}

double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double quantile(std::vector<double> values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::ranges::nth_element(values, at);
    return *at;
}

}  // namespace haptoflow::recordings
