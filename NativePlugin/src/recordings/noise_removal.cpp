#include "recordings/noise_removal.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::recordings {
namespace {

constexpr std::size_t bins = ShortTimeSpectrum::bins;
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
