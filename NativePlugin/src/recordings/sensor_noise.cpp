#include "recordings/sensor_noise.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/sample_rates.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

namespace haptoflow::recordings {
namespace {

using Complex = std::complex<double>;
using Window = std::array<double, ShortTimeSpectrum::frameSamples>;

Window squareRootHann() {
    Window window{};
    for (std::size_t i = 0; i < window.size(); ++i) {
        window[i] = std::sin(std::numbers::pi * static_cast<double>(i) / static_cast<double>(window.size()));
    }
    return window;
}

}  // namespace

ShortTimeSpectrum::ShortTimeSpectrum(std::span<const float> wave) : samples_(wave.size()) {
    const Window window = squareRootHann();
    const std::size_t frames = (samples_ + hop - 1) / hop + 1;
    values_.reserve(frames * bins);
    std::vector<Complex> frame(frameSamples);
    for (std::size_t each = 0; each < frames; ++each) {
        for (std::size_t i = 0; i < frameSamples; ++i) {
            const std::size_t sample = each * hop + i;
            const bool isInside = sample >= hop && sample - hop < samples_;
            frame[i] = isInside ? window[i] * static_cast<double>(wave[sample - hop]) : 0.0;
        }
        dsp::fourierTransform(frame, dsp::Direction::forward);
        values_.insert(values_.end(), frame.begin(), frame.begin() + bins);
    }
}

SpectrumCells ShortTimeSpectrum::power() const {
    SpectrumCells cells(values_.size());
    std::ranges::transform(values_, cells.begin(), [](const Complex& value) { return std::norm(value); });
    return cells;
}

void ShortTimeSpectrum::scale(const SpectrumCells& gains) {
    for (std::size_t i = 0; i < values_.size(); ++i) {
        values_[i] *= gains[i];
    }
}

std::vector<float> ShortTimeSpectrum::wave() const {
    const Window window = squareRootHann();
    std::vector<double> sum((frames() + 1) * hop);
    std::vector<Complex> frame(frameSamples);
    for (std::size_t each = 0; each < frames(); ++each) {
        const auto first = values_.begin() + static_cast<std::ptrdiff_t>(each * bins);
        std::copy_n(first, bins, frame.begin());
        for (std::size_t bin = 1; bin + 1 < bins; ++bin) {
            frame[frameSamples - bin] = std::conj(frame[bin]);
        }
        dsp::fourierTransform(frame, dsp::Direction::inverse);
        for (std::size_t i = 0; i < frameSamples; ++i) {
            sum[each * hop + i] += window[i] * frame[i].real();
        }
    }
    std::vector<float> wave(samples_);
    std::transform(sum.begin() + hop, sum.begin() + static_cast<std::ptrdiff_t>(hop + samples_), wave.begin(),
                   [](double value) { return static_cast<float>(value); });
    return wave;
}

double ShortTimeSpectrum::meanSquare(std::span<const double> power) {
    double sum = 0.0;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        sum += (bin == 0 || bin + 1 == bins ? 1.0 : 2.0) * power[bin];
    }
    constexpr double windowEnergy = 0.5 * frameSamples;
    return sum / (static_cast<double>(frameSamples) * windowEnergy);
}

namespace {

constexpr std::size_t bins = ShortTimeSpectrum::bins;
constexpr double lightestTouchNewtons = 0.02;
/// A tracker's noise gives a resting tip this speed now and then, but not for long.
constexpr double restMps = 0.004;
constexpr double meanRestMps = 0.002;
/// A hand in the air is never as still as on a surface.
constexpr double restInAirMps = 0.02;
/// The filters ring, and the means of the motion reach, for this long.
constexpr std::size_t restMarginSamples = 100;

/// How the tip moves during one frame of a ShortTimeSpectrum.
struct FrameMotion {
    /// False at the ends of the recording and where the motion is unknown; the other members then mean nothing.
    bool isUsable = false;
    /// The tip rests from 50 ms before the frame to 50 ms after it.
    bool isResting = false;
    bool isTouching = false;
    double speedMps = 0.0;
};

/// Numbers of frames of a ShortTimeSpectrum, ascending.
using Frames = std::vector<std::size_t>;

/// The usable frames of which `condition` holds.
template <typename Condition>
Frames framesWhere(std::span<const FrameMotion> motion, Condition condition) {
    Frames frames;
    for (std::size_t frame = 0; frame < motion.size(); ++frame) {
        if (motion[frame].isUsable && condition(motion[frame])) {
            frames.push_back(frame);
        }
    }
    return frames;
}

/// How often something holds before each sample, and before the end.
class Count {
public:
    template <typename Condition>
    Count(std::size_t samples, Condition condition) : before_(samples + 1) {
        for (std::size_t i = 0; i < samples; ++i) {
            before_[i + 1] = before_[i] + (condition(i) ? 1U : 0U);
        }
    }

    [[nodiscard]] bool isFull(std::size_t first, std::size_t end) const {
        return before_[end] - before_[first] == end - first;
    }

private:
    std::vector<std::uint32_t> before_;
};

/// For each frame. `motion`, for each sample: vx, vy in m/s and force in N.
std::vector<FrameMotion> motionOfFrames(std::size_t frames, std::span<const std::array<float, 3>> motion,
                                        std::span<const std::uint8_t> isUsable) {
    constexpr std::size_t hop = ShortTimeSpectrum::hop;
    constexpr std::size_t length = ShortTimeSpectrum::frameSamples;
    const std::size_t count = motion.size();
    const auto speedAt = [&](std::size_t i) {
        return std::hypot(static_cast<double>(motion[i][0]), static_cast<double>(motion[i][1]));
    };
    const Count usable(count, [&](std::size_t i) { return isUsable[i] != 0; });
    const Count resting(count, [&](std::size_t i) {
        const bool isInAir = motion[i][2] < lightestTouchNewtons;
        return isUsable[i] != 0 && speedAt(i) < (isInAir ? restInAirMps : restMps);
    });
    std::vector<FrameMotion> result(frames);
    for (std::size_t frame = 1; frame < frames; ++frame) {
        const std::size_t first = (frame - 1) * hop;
        const std::size_t end = first + length;
        if (end > count || !usable.isFull(first, end)) {
            continue;
        }
        FrameMotion& each = result[frame];
        each.isUsable = true;
        const std::size_t from = first - std::min(first, restMarginSamples);
        const std::size_t to = std::min(end + restMarginSamples, count);
        const std::array<double, 3> around = meanMotionOf(motion.subspan(from, to - from));
        each.isResting = resting.isFull(from, to) &&
                         (around[2] < lightestTouchNewtons || std::hypot(around[0], around[1]) < meanRestMps);
        each.isTouching = meanMotionOf(motion.subspan(first, length))[2] >= lightestTouchNewtons;
        for (std::size_t i = first; i < end; ++i) {
            each.speedMps += speedAt(i) / static_cast<double>(length);
        }
    }
    return result;
}

/// Mean square of each frame.
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

double meanOf(std::span<const double> values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Mean over two bins on each side: noise has a smooth spectrum, and few frames of it a rough one.
std::vector<double> smoothed(std::span<const double> spectrum) {
    constexpr std::size_t reach = 2;
    std::vector<double> result(spectrum.size());
    for (std::size_t bin = 0; bin < spectrum.size(); ++bin) {
        const std::size_t first = bin - std::min(bin, reach);
        result[bin] = meanOf(spectrum.subspan(first, std::min(bin + reach + 1, spectrum.size()) - first));
    }
    return result;
}

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

/// The mean power of the sensor's noise in each bin, found where the tip is slower than 15 mm/s. A straight line is
/// fitted to the power over speed^1.2, and its value at speed zero is the noise. The power of every label grows at
/// least as fast as speed^1.2, so that the line never takes a part of the texture for noise.
///
/// None unless that is most of what is there, steady, below 0.1 m/s^2 and far below the level of fast strokes: a
/// texture must never be taken for noise.
std::optional<std::vector<double>> noiseOfQuietPart(const SpectrumCells& power, std::span<const FrameMotion> motion) {
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

/// Finds the noise where the tip rests for 0.2 s or more in all, knocks left out; otherwise in the quiet part. A rest
/// that is louder than the quietest sliding is not believed: then the motion is wrong. Throws RecordingUnusable if the
/// recording is no stronger where the tip slides than where it rests.
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

/// Frames and bins on each side whose mean power stands for a cell's: enough that the power of noise hardly varies.
constexpr std::size_t narrowFrames = 2;
constexpr std::size_t wideFrames = 16;
constexpr std::size_t neighbourBins = 2;
/// White and coloured noise exceed their expectation by this factor, over the narrow neighbourhood, in 0.3 % of cells.
constexpr double clearRatio = 1.9;
constexpr double lowestPowerGain = 0.01;

/// Sums over `reach` frames and `neighbourBins` bins on each side; fewer at the ends.
SpectrumCells sumsAround(const SpectrumCells& cells, std::size_t reach) {
    const std::size_t frames = cells.size() / bins;
    SpectrumCells overBins(cells.size());
    for (std::size_t frame = 0; frame < frames; ++frame) {
        for (std::size_t bin = 0; bin < bins; ++bin) {
            const std::size_t end = std::min(bin + neighbourBins + 1, bins);
            for (std::size_t other = bin - std::min(bin, neighbourBins); other < end; ++other) {
                overBins[frame * bins + bin] += cells[frame * bins + other];
            }
        }
    }
    SpectrumCells sums(cells.size());
    for (std::size_t frame = 0; frame < frames; ++frame) {
        const std::size_t end = std::min(frame + reach + 1, frames);
        for (std::size_t other = frame - std::min(frame, reach); other < end; ++other) {
            for (std::size_t bin = 0; bin < bins; ++bin) {
                sums[frame * bins + bin] += overBins[other * bins + bin];
            }
        }
    }
    return sums;
}

/// The share of a cell's power that is left without the noise: 1 where there is none, never below the lowest gain.
double shareOf(double power, double noise) {
    return noise > 0.0 ? std::max(1.0 - noise / std::max(power, noise), lowestPowerGain) : 1.0;
}

/// A cell that stands out from the noise takes the share of its narrow neighbourhood, which follows attacks and
/// strokes. The others share a wide one: their estimates are uncertain, and cut off at zero one by one they would not
/// have the right mean.
SpectrumCells gainsOf(SpectrumCells power, std::span<const double> noisePower, std::span<const FrameMotion> motion) {
    SpectrumCells noise(power.size());
    for (std::size_t cell = 0; cell < power.size(); ++cell) {
        const bool isUsable = motion[cell / bins].isUsable;
        noise[cell] = isUsable ? noisePower[cell % bins] : 0.0;
        power[cell] = isUsable ? power[cell] : 0.0;
    }
    const SpectrumCells narrowPower = sumsAround(power, narrowFrames);
    const SpectrumCells narrowNoise = sumsAround(noise, narrowFrames);
    const auto isClear = [&](std::size_t cell) { return narrowPower[cell] > clearRatio * narrowNoise[cell]; };
    for (std::size_t cell = 0; cell < power.size(); ++cell) {
        if (isClear(cell)) {
            power[cell] = 0.0;
            noise[cell] = 0.0;
        }
    }
    const SpectrumCells widePower = sumsAround(power, wideFrames);
    const SpectrumCells wideNoise = sumsAround(noise, wideFrames);
    SpectrumCells gains(power.size(), 1.0);
    for (std::size_t cell = 0; cell < gains.size(); ++cell) {
        if (motion[cell / bins].isUsable) {
            gains[cell] = std::sqrt(isClear(cell) ? shareOf(narrowPower[cell], narrowNoise[cell])
                                                  : shareOf(widePower[cell], wideNoise[cell]));
        }
    }
    return gains;
}

}  // namespace

std::array<double, 3> meanMotionOf(std::span<const std::array<float, 3>> motion) {
    std::array<double, 3> mean{};
    for (const std::array<float, 3>& each : motion) {
        for (std::size_t axis = 0; axis < mean.size(); ++axis) {
            mean[axis] += static_cast<double>(each[axis]) / static_cast<double>(motion.size());
        }
    }
    return mean;
}

std::string_view nameOf(NoiseSource source) {
    constexpr std::array<std::string_view, 3> names{"none", "rest", "quiet part"};
    return names[static_cast<std::size_t>(source)];
}

SensorNoise removeSensorNoise(std::span<float> wave, std::span<const std::array<float, 3>> motion,
                              std::span<const std::uint8_t> isUsable) {
    ShortTimeSpectrum spectrum(wave);
    const std::vector<FrameMotion> frames = motionOfFrames(spectrum.frames(), motion, isUsable);
    const SpectrumCells power = spectrum.power();
    SensorNoise noise = findSensorNoise(power, frames);
    if (noise.source != NoiseSource::none) {
        spectrum.scale(gainsOf(power, noise.power, frames));
        std::ranges::copy(spectrum.wave(), wave.begin());
    }
    return noise;
}

}  // namespace haptoflow::recordings
