#include "recordings/quiet_part.hpp"

#include "recordings/frame_statistics.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::recordings {
namespace {

constexpr double slowMps = 0.015;
constexpr double fastMps = 0.04;
constexpr double slowestGrowth = 1.2;
constexpr std::size_t minimumFrames = 16;
/// Upper quartile of speed^1.2 over the lower one: a line needs a length.
constexpr double minimumSpread = 1.5;
constexpr double minimumShare = 0.5;
constexpr double minimumCertainty = 3.0;
constexpr double maximumUnsteadiness = 0.5;
constexpr double minimumFastRatio = 4.0;
constexpr double maximumMps2 = 0.1;

struct Line {
    double atZero = 0.0;
    double atZeroError = 0.0;
};

Line lineThrough(std::span<const double> places, std::span<const double> values) {
    const auto count = static_cast<double>(places.size());
    const double meanPlace = meanOf(places);
    const double meanValue = meanOf(values);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        squares += (places[i] - meanPlace) * (places[i] - meanPlace);
        products += (places[i] - meanPlace) * (values[i] - meanValue);
    }
    const double slope = products / squares;
    double residual = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const double off = values[i] - meanValue - slope * (places[i] - meanPlace);
        residual += off * off / (count - 2.0);
    }
    return {.atZero = meanValue - slope * meanPlace,
            .atZeroError = std::sqrt(residual * (1.0 / count + meanPlace * meanPlace / squares))};
}

double deviationOf(std::span<const double> values) {
    const double mean = meanOf(values);
    double squares = 0.0;
    for (const double value : values) {
        squares += (value - mean) * (value - mean);
    }
    return std::sqrt(squares / static_cast<double>(values.size()));
}

bool isNoise(double left, double error, std::span<const double> slow, double fast) {
    const double mean = meanOf(slow);
    return left >= minimumShare * mean && left >= minimumCertainty * error && left <= maximumMps2 * maximumMps2 &&
           deviationOf(slow) <= maximumUnsteadiness * mean && fast >= minimumFastRatio * left;
}

}  // namespace

std::optional<std::vector<double>> noiseOfQuietPart(const SpectrumCells& power, std::span<const FrameMotion> motion) {
    constexpr std::size_t bins = ShortTimeSpectrum::bins;
    const Frames slow = framesWhere(motion, [](const FrameMotion& each) { return each.speedMps < slowMps; });
    const Frames fast = framesWhere(motion, [](const FrameMotion& each) { return each.speedMps > fastMps; });
    if (slow.size() < minimumFrames || fast.size() < minimumFrames) {
        return std::nullopt;
    }
    std::vector<double> growth(slow.size());
    std::ranges::transform(slow, growth.begin(),
                           [&](std::size_t frame) { return std::pow(motion[frame].speedMps, slowestGrowth); });
    if (!(quantile(growth, 0.75) > minimumSpread * quantile(growth, 0.25))) {
        return std::nullopt;
    }
    const std::vector<double> levels = meanSquaresOf(power, slow);
    const Line level = lineThrough(growth, levels);
    if (!isNoise(level.atZero, level.atZeroError, levels, quantile(meanSquaresOf(power, fast), 0.5))) {
        return std::nullopt;
    }
    std::vector<double> noise(bins);
    std::vector<double> values(slow.size());
    for (std::size_t bin = 0; bin < bins; ++bin) {
        std::ranges::transform(slow, values.begin(), [&](std::size_t frame) { return power[frame * bins + bin]; });
        noise[bin] = std::clamp(lineThrough(growth, values).atZero, 0.0, meanOf(values));
    }
    return smoothed(noise);
}

}  // namespace haptoflow::recordings
