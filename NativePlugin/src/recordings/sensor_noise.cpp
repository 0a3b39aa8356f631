#include "recordings/sensor_noise.hpp"

#include "dsp/sample_rates.hpp"
#include "recordings/frame_statistics.hpp"
#include "recordings/quiet_part.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace haptoflow::recordings {
namespace {

constexpr std::size_t bins = ShortTimeSpectrum::bins;
constexpr double minimumRestSeconds = 0.2;
/// A louder resting frame, against the median one, has felt a knock or the hand.
constexpr double knockRatio = 3.0;
constexpr double slidingMps = 0.004;
/// Fewer say nothing of what is quiet.
constexpr std::size_t minimumSlidingFrames = 20;
/// Noise alone is up to 1.7 times as strong as the quietest tenth of its own means over five frames.
constexpr double quietestTenth = 0.1;
constexpr double aboveQuietest = 2.0;
/// A recording whose loud parts are hardly louder than its rest is nothing but noise.
constexpr double loud = 0.9;
constexpr double onlyNoiseRatio = 1.25;
/// A twentieth of what a hand can feel.
constexpr double negligibleMps2 = 0.002;

/// The quietest power of each bin while the tip slides, over five frames and five bins.
std::vector<double> quietestOf(const SpectrumCells& power, const Frames& sliding) {
    constexpr std::size_t together = 5;
    std::vector<std::vector<double>> means(bins);
    for (std::size_t first = 0; first + together <= sliding.size(); ++first) {
        const std::vector<double> mean = smoothed(meanSpectrum(power, std::span(sliding).subspan(first, together)));
        for (std::size_t bin = 0; bin < bins; ++bin) {
            means[bin].push_back(mean[bin]);
        }
    }
    std::vector<double> quietest(bins);
    std::ranges::transform(means, quietest.begin(),
                           [](std::vector<double>& each) { return quantile(std::move(each), quietestTenth); });
    return quietest;
}

void requireMoreThanNoise(const SpectrumCells& power, const Frames& sliding, const Frames& resting) {
    const double rest = quantile(meanSquaresOf(power, resting), loud);
    if (quantile(meanSquaresOf(power, sliding), loud) < onlyNoiseRatio * rest) {
        throw RecordingUnusable("the acceleration is no stronger where the tip slides than where it rests (" +
                                plainNumber(std::sqrt(rest)) +
                                " m/s^2), so it is only the sensor's noise; is the sensor fixed to the stylus?");
    }
}

std::optional<std::vector<double>> noiseAtRest(const SpectrumCells& power, std::span<const FrameMotion> motion) {
    constexpr double hopSeconds = static_cast<double>(ShortTimeSpectrum::hop) / dsp::waveformRateHz;
    const Frames resting = framesWhere(motion, [](const FrameMotion& each) { return each.isResting; });
    if (static_cast<double>(resting.size()) * hopSeconds < minimumRestSeconds) {
        return std::nullopt;
    }
    const std::vector<double> levels = meanSquaresOf(power, resting);
    const double loudest = knockRatio * quantile(levels, 0.5);
    Frames still;
    for (std::size_t i = 0; i < resting.size(); ++i) {
        if (levels[i] <= loudest) {
            still.push_back(resting[i]);
        }
    }
    std::vector<double> noise = smoothed(meanSpectrum(power, still));
    const Frames sliding =
        framesWhere(motion, [](const FrameMotion& each) { return each.isTouching && each.speedMps >= slidingMps; });
    const double level = ShortTimeSpectrum::meanSquare(noise);
    if (sliding.size() < minimumSlidingFrames || level < negligibleMps2 * negligibleMps2) {
        return noise;
    }
    const std::vector<double> quietest = quietestOf(power, sliding);
    if (level > aboveQuietest * ShortTimeSpectrum::meanSquare(quietest)) {
        return std::nullopt;
    }
    requireMoreThanNoise(power, sliding, still);
    for (std::size_t bin = 0; bin < bins; ++bin) {
        noise[bin] = std::min(noise[bin], aboveQuietest * quietest[bin]);
    }
    return noise;
}

}  // namespace

std::string_view nameOf(NoiseSource source) {
    constexpr std::array<std::string_view, 3> names{"none", "rest", "quiet part"};
    return names[static_cast<std::size_t>(source)];
}

SensorNoise findSensorNoise(const SpectrumCells& power, std::span<const FrameMotion> motion) {
    SensorNoise noise{.source = NoiseSource::rest, .rmsMps2 = 0.0, .power = {}};
    std::optional<std::vector<double>> found = noiseAtRest(power, motion);
    if (!found) {
        noise.source = NoiseSource::quietPart;
        found = noiseOfQuietPart(power, motion);
    }
    noise.power = std::move(found).value_or(std::vector<double>(bins));
    noise.rmsMps2 = std::sqrt(ShortTimeSpectrum::meanSquare(noise.power));
    return noise.rmsMps2 >= negligibleMps2 ? noise : SensorNoise{};
}

}  // namespace haptoflow::recordings
