#include "effects/carrier_rendering.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::effects {
namespace {

constexpr double heldEdgeSeconds = 0.0005;

struct Carrier {
    double amplitudeMps2 = 0.0;
    double frequencyHz = 0.0;
};

Carrier carrierOf(const WaveFrame& frame) noexcept {
    return {static_cast<double>(frame.amplitudeMps2), static_cast<double>(frame.frequencyHz)};
}

Carrier between(const Carrier& from, const Carrier& to, double share) noexcept {
    return {from.amplitudeMps2 + share * (to.amplitudeMps2 - from.amplitudeMps2),
            from.frequencyHz + share * (to.frequencyHz - from.frequencyHz)};
}

double startSeconds(const WaveFrame& frame) noexcept {
    return static_cast<double>(frame.firstSample) / WaveFeatures::sampleRateHz;
}

double endSeconds(const WaveFrame& frame) noexcept {
    return static_cast<double>(frame.firstSample + frame.sampleCount) / WaveFeatures::sampleRateHz;
}

double middleSeconds(const WaveFrame& frame) noexcept {
    return 0.5 * (startSeconds(frame) + endSeconds(frame));
}

Carrier heldAt(std::span<const WaveFrame> frames, std::size_t index, double seconds) noexcept {
    const Carrier before = index > 0 ? carrierOf(frames[index - 1]) : Carrier{0.0, carrierOf(frames[0]).frequencyHz};
    const double share = (seconds - startSeconds(frames[index])) / heldEdgeSeconds;
    return between(before, carrierOf(frames[index]), std::clamp(share, 0.0, 1.0));
}

Carrier linearAt(std::span<const WaveFrame> frames, std::size_t index, double seconds) noexcept {
    const bool isBeforeMiddle = seconds < middleSeconds(frames[index]);
    const std::size_t from = isBeforeMiddle ? index - std::min<std::size_t>(1, index) : index;
    const std::size_t to = std::min(from + 1, frames.size() - 1);
    const double length = middleSeconds(frames[to]) - middleSeconds(frames[from]);
    const double share = length > 0.0 ? (seconds - middleSeconds(frames[from])) / length : 0.0;
    return between(carrierOf(frames[from]), carrierOf(frames[to]), std::clamp(share, 0.0, 1.0));
}

}  // namespace

std::vector<float> renderCarrier(std::span<const WaveFrame> frames, CarrierShape shape) {
    if (frames.empty()) {
        return {};
    }
    constexpr double rateHz = WaveFeatures::sampleRateHz;
    const double start = startSeconds(frames.front());
    std::vector<float> wave(static_cast<std::size_t>(std::llround((endSeconds(frames.back()) - start) * rateHz)));
    double cycles = 0.0;
    std::size_t index = 0;
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double seconds = start + (static_cast<double>(i) + 0.5) / rateHz;
        while (index + 1 < frames.size() && seconds >= endSeconds(frames[index])) {
            ++index;
        }
        const Carrier carrier =
            shape == CarrierShape::held ? heldAt(frames, index, seconds) : linearAt(frames, index, seconds);
        cycles = std::fmod(cycles + carrier.frequencyHz / rateHz, 1.0);
        wave[i] = static_cast<float>(carrier.amplitudeMps2 * std::sin(2.0 * std::numbers::pi * cycles));
    }
    return wave;
}

std::vector<WaveFrame> framesOf(std::span<const float> waveMps2, const WaveFeatureOptions& options) {
    WaveFeatures features(options);
    // Silence after the end completes the last frame.
    const auto longest = static_cast<std::size_t>(std::ceil(options.frameSeconds * WaveFeatures::sampleRateHz));
    std::vector<float> wave(waveMps2.begin(), waveMps2.end());
    wave.resize(waveMps2.size() + longest + WaveFeatures::lookaheadSamples, 0.0F);
    std::vector<WaveFrame> frames(features.framesWithin(wave.size()));
    frames.resize(features.process(wave, frames).frames);
    std::erase_if(frames, [&](const WaveFrame& frame) { return frame.firstSample >= waveMps2.size(); });
    return frames;
}

IntensityErrors intensityErrors(std::span<const float> wantedMps2, std::span<const float> playedMps2,
                                const WaveFeatureOptions& options) {
    const std::vector<WaveFrame> wanted = framesOf(wantedMps2, options);
    const std::vector<WaveFrame> played = framesOf(playedMps2, options);
    std::vector<double> magnitudes;
    double sumDb = 0.0;
    double sumOfMagnitudesDb = 0.0;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const auto wantedIntensity = static_cast<double>(wanted[i].intensity);
        const double playedIntensity = i < played.size() ? static_cast<double>(played[i].intensity) : 0.0;
        if (std::max(wantedIntensity, playedIntensity) >= 1.0) {
            const double errorDb = 20.0 * std::log10(std::max(playedIntensity, 1.0) / std::max(wantedIntensity, 1.0));
            sumDb += errorDb;
            sumOfMagnitudesDb += std::abs(errorDb);
            magnitudes.push_back(std::abs(errorDb));
        }
    }
    if (magnitudes.empty()) {
        return {};
    }
    std::ranges::sort(magnitudes);
    const auto count = static_cast<double>(magnitudes.size());
    const auto rank = static_cast<std::size_t>(std::ceil(0.95 * count)) - 1;
    return {.feltFrames = magnitudes.size(),
            .meanDb = sumDb / count,
            .meanMagnitudeDb = sumOfMagnitudesDb / count,
            .percentile95Db = magnitudes[rank]};
}

}  // namespace haptoflow::effects
