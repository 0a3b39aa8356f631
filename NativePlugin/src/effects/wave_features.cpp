#include "effects/wave_features.hpp"

#include "dsp/fourier_transform.hpp"
#include "effects/perceived_intensity.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>

namespace haptoflow::effects {
namespace {

constexpr double attenuationDecibels = 51.0;

}  // namespace

WaveDecimation::WaveDecimation(std::size_t factor) : factor_(factor), untilNext_(factor) {
    if (factor < 1 || factor > maximumFactor) {
        throw std::invalid_argument("decimation by " + std::to_string(factor) + "; expected 1 to " +
                                    std::to_string(maximumFactor));
    }
    if (factor == 1) {
        return;
    }
    const auto half = static_cast<double>(delaySamples * factor);
    kernel_.resize(2 * delaySamples * factor + 1);
    for (std::size_t i = 0; i < kernel_.size(); ++i) {
        const double distance = static_cast<double>(i) - half;
        kernel_[i] = static_cast<float>(dsp::normalisedSinc(distance / static_cast<double>(factor)) *
                                        dsp::kaiserWindow(distance / half, dsp::kaiserBeta(attenuationDecibels)));
    }
    const float sum = std::accumulate(kernel_.begin(), kernel_.end(), 0.0F);
    std::ranges::for_each(kernel_, [sum](float& weight) { weight /= sum; });
    newest_.resize(kernel_.size());
}

bool WaveDecimation::take(float sample, float& decimated) noexcept {
    if (factor_ == 1) {
        decimated = sample;
        return true;
    }
    newest_[place_] = std::isfinite(sample) ? sample : 0.0F;
    place_ = (place_ + 1) % newest_.size();
    if (--untilNext_ > 0) {
        return false;
    }
    untilNext_ = factor_;
    // place_ is the oldest sample. The kernel is symmetric, so the direction of time does not matter.
    const auto seam = newest_.begin() + static_cast<std::ptrdiff_t>(place_);
    const auto behind = kernel_.begin() + (newest_.end() - seam);
    decimated = std::inner_product(seam, newest_.end(), kernel_.begin(), 0.0F);
    decimated = std::inner_product(newest_.begin(), seam, behind, decimated);
    return true;
}

void WaveDecimation::reset() noexcept {
    std::ranges::fill(newest_, 0.0F);
    place_ = 0;
    untilNext_ = factor_;
}

namespace {

constexpr double binHz = WaveFeatures::sampleRateHz / static_cast<double>(ThresholdFilter::taps);
constexpr std::size_t windowFall = 16;
// An onset: the ratio of the energy in 4 ms to the preceding average (10.8 dB), its minimum amplitude in multiples of
// the detection threshold, and the minimum time between two, 30 ms.
constexpr double onsetEnergyRatio = 12.0;
constexpr double onsetThresholds = 3.0;
constexpr std::uint64_t refractorySamples = 60;
constexpr std::size_t fastSamples = 8;
constexpr std::size_t slowLag = 10;
constexpr double slowSeconds = 0.03;
constexpr std::size_t onsetSearchSamples = 16;
constexpr double onsetShareOfPeak = 0.25;
constexpr std::size_t transientSamples = 16;
// Larger than in any real wave; keeps squares finite for any input.
constexpr double maximumMps2 = 1e6;
// Value of r^2 below which nothing is felt and the spectrum is meaningless.
constexpr double imperceptible = 1e-6;
constexpr double firstCentroidHz = 160.0;
// Where the centroids of textures lie.
constexpr double lowestTextureHz = 50.0;
constexpr double highestTextureHz = 240.0;
constexpr double followSeconds = 0.015;
constexpr double frequencyFollowSeconds = 0.04;
constexpr double suddenRise = 4.0;
constexpr double suddenFall = 8.0;
constexpr double suddenSeconds = 0.03;

}  // namespace

bool WaveFeatureOptions::isValid() const noexcept {
    return frameSeconds >= 0.002 && frameSeconds <= 0.032 && minFrequencyHz > 0.0 && minFrequencyHz <= maxFrequencyHz &&
           maxFrequencyHz <= 1000.0;
}

WaveFeatures::WaveFeatures(const WaveFeatureOptions& options)
    : options_(options),
      filter_(ThresholdFilter::shared()),
      frameSamples_(options.frameSeconds * sampleRateHz),
      slowShare_(1.0 - std::exp(-1.0 / (slowSeconds * sampleRateHz))) {
    if (!options.isValid()) {
        throw std::invalid_argument(
            "wave features: expected frames of 2 to 32 ms and a device range within 0 to 1000 Hz");
    }
    for (std::size_t i = 0; i < historySamples; ++i) {
        const std::size_t fromEnd = historySamples - i;
        const double share = fromEnd <= windowFall
                                 ? static_cast<double>(fromEnd) / static_cast<double>(windowFall)
                                 : static_cast<double>(i + 1) / static_cast<double>(historySamples - windowFall);
        window_[i] = std::pow(std::sin(0.5 * std::numbers::pi * share), 2.0);
        cosines_[i] = std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(historySamples));
    }
    double windowSum = 0.0;
    for (const double value : window_) {
        windowSum += value;
    }
    thresholdEnergy_ = 0.25 * windowSum * windowSum;
    for (std::size_t bin = 0; bin < bins; ++bin) {
        const double frequencyHz = binHz * static_cast<double>(bin);
        exponents_[bin] = intensityExponent(frequencyHz);
        logFrequencies_[bin] = bin > 0 ? std::log(frequencyHz) : 0.0;
        squaredThresholds_[bin] = std::pow(detectionThresholdMps2(frequencyHz), 2.0);
    }
    reset();
}

void WaveFeatures::reset() noexcept {
    wave_.fill(0.0);
    thresholds_.fill(0.0);
    taken_ = 0;
    frame_ = 0;
    weightedCentroidHz_ = firstCentroidHz;
    centroidHz_ = firstCentroidHz;
    square_ = 0.0;
    lastSquare_ = 0.0;
    suddenUntil_ = 0;
    slowEnergy_ = 0.0;
    fastEnergy_ = 0.0;
    hasOnset_ = false;
    onset_ = 0;
    refractoryUntil_ = 0;
}

void WaveFeatures::setDeviceRange(double minFrequencyHz, double maxFrequencyHz) noexcept {
    if (minFrequencyHz > 0.0 && minFrequencyHz <= maxFrequencyHz && maxFrequencyHz <= 1000.0) {
        options_.minFrequencyHz = minFrequencyHz;
        options_.maxFrequencyHz = maxFrequencyHz;
    }
}

std::size_t WaveFeatures::framesWithin(std::size_t samples) const noexcept {
    return static_cast<std::size_t>(static_cast<double>(samples) / frameSamples_) + 2;
}

std::uint64_t WaveFeatures::frameStart(std::uint64_t frame) const noexcept {
    return static_cast<std::uint64_t>(std::llround(static_cast<double>(frame) * frameSamples_));
}

bool WaveFeatures::isFrameDue() const noexcept {
    return taken_ >= frameStart(frame_ + 1) + lookaheadSamples;
}

WaveFeatures::Progress WaveFeatures::process(std::span<const float> waveMps2, std::span<WaveFrame> frames) noexcept {
    Progress progress;
    while (true) {
        if (isFrameDue()) {
            if (progress.frames == frames.size()) {
                return progress;
            }
            frames[progress.frames++] = finishFrame();
        }
        if (progress.samples == waveMps2.size()) {
            return progress;
        }
        const float sample = waveMps2[progress.samples++];
        take(std::isfinite(sample) ? std::clamp(static_cast<double>(sample), -maximumMps2, maximumMps2) : 0.0);
    }
}

void WaveFeatures::take(double mps2) noexcept {
    const std::size_t at = taken_ % historySamples;
    wave_[at] = mps2;
    thresholds_[at] = filtered();
    ++taken_;
    followEnergy();
    detectOnset();
}

double WaveFeatures::filtered() const noexcept {
    double sum = 0.0;
    for (std::size_t tap = 0; tap < historySamples; ++tap) {
        sum += filter_.impulseResponse()[tap] * wave_[(taken_ - tap) % historySamples];
    }
    return sum;
}

void WaveFeatures::followEnergy() noexcept {
    const auto squareBefore = [this](std::size_t samples) {
        const double value = thresholds_[(taken_ - 1 - samples) % historySamples];
        return value * value;
    };
    double squares = 0.0;
    for (std::size_t before = 0; before < fastSamples; ++before) {
        squares += squareBefore(before);
    }
    fastEnergy_ = squares / static_cast<double>(fastSamples);
    slowEnergy_ += slowShare_ * (squareBefore(slowLag) - slowEnergy_);
}

void WaveFeatures::detectOnset() noexcept {
    if (taken_ < refractoryUntil_ || hasOnset_) {
        return;
    }
    const bool isFelt = fastEnergy_ > 0.5 * onsetThresholds * onsetThresholds;
    if (isFelt && fastEnergy_ > onsetEnergyRatio * slowEnergy_) {
        hasOnset_ = true;
        onset_ = onsetBefore(taken_);
        refractoryUntil_ = taken_ + refractorySamples;
    }
}

std::uint64_t WaveFeatures::onsetBefore(std::uint64_t end) const noexcept {
    const std::uint64_t start = end - std::min<std::uint64_t>(end, onsetSearchSamples);
    double peak = 0.0;
    for (std::uint64_t i = start; i < end; ++i) {
        peak = std::max(peak, std::abs(wave_[i % historySamples]));
    }
    for (std::uint64_t i = start; i < end; ++i) {
        if (std::abs(wave_[i % historySamples]) >= onsetShareOfPeak * peak) {
            return i;
        }
    }
    return end - 1;
}

WaveFrame WaveFeatures::finishFrame() noexcept {
    const std::uint64_t start = frameStart(frame_);
    const std::uint64_t end = frameStart(frame_ + 1);
    ++frame_;
    const Spectrum spectrum = spectrumOfHistory();
    if (spectrum.energy > imperceptible) {
        weightedCentroidHz_ = spectrum.weightedCentroidHz;
    }
    const double square = spectrum.energy > imperceptible ? 2.0 * meanSquare(start, end, weightedCentroidHz_) : 0.0;
    const WaveTransient transient = transientWithin(start, end);
    follow(square, spectrum, transient.amplitudeMps2 > 0.0F);
    const double intensity =
        spectrum.energy > imperceptible ? intensityOfRatio(std::sqrt(square_), spectrum.exponent) : 0.0;
    const double frequencyHz = onDevice(centroidHz_);
    return {.firstSample = start,
            .sampleCount = static_cast<std::uint32_t>(end - start),
            .intensity = static_cast<float>(intensity),
            .centroidHz = static_cast<float>(centroidHz_),
            .frequencyHz = static_cast<float>(frequencyHz),
            .amplitudeMps2 = static_cast<float>(amplitudeOfIntensity(intensity, frequencyHz)),
            .transient = transient};
}

void WaveFeatures::follow(double square, const Spectrum& spectrum, bool hasOnset) noexcept {
    const double frameSeconds = frameSamples_ / sampleRateHz;
    if (hasOnset) {
        suddenUntil_ = frame_ + static_cast<std::uint64_t>(std::ceil(suddenSeconds / frameSeconds));
    }
    if (frame_ == suddenUntil_ && square < lastSquare_) {
        ++suddenUntil_;
    }
    if (suddenFall * std::max(square, lastSquare_) < square_) {
        suddenUntil_ = std::max(suddenUntil_, frame_ + 1);
    }
    const bool isSudden = frame_ <= suddenUntil_ || square > suddenRise * square_;
    square_ = isSudden ? square : square_ + (1.0 - std::exp(-frameSeconds / followSeconds)) * (square - square_);
    lastSquare_ = square;
    if (spectrum.feltHz > 0.0) {
        const double share = isSudden ? 1.0 : 1.0 - std::exp(-frameSeconds / frequencyFollowSeconds);
        centroidHz_ *= std::pow(spectrum.feltHz / centroidHz_, share);
    }
}

WaveFeatures::Spectrum WaveFeatures::spectrumOfHistory() const noexcept {
    History windowed;
    for (std::size_t i = 0; i < historySamples; ++i) {
        windowed[i] = window_[i] * thresholds_[(taken_ + i) % historySamples];
    }
    Spectrum spectrum;
    double feltEnergy = 0.0;
    double logFrequency = 0.0;
    for (std::size_t bin = 1; bin < bins; ++bin) {
        double real = 0.0;
        double imaginary = 0.0;
        for (std::size_t i = 0; i < historySamples; ++i) {
            real += windowed[i] * cosines_[bin * i % historySamples];
            imaginary += windowed[i] * cosines_[(bin * i + 3 * historySamples / 4) % historySamples];
        }
        const double energy = real * real + imaginary * imaginary;
        spectrum.energy += energy;
        spectrum.weightedCentroidHz += energy * static_cast<double>(bin);
        spectrum.exponent += energy * exponents_[bin];
        if (energy > thresholdEnergy_) {
            const double felt = energy * squaredThresholds_[bin];
            feltEnergy += felt;
            logFrequency += felt * logFrequencies_[bin];
        }
    }
    if (feltEnergy > 0.0) {
        spectrum.feltHz = std::exp(logFrequency / feltEnergy);
    }
    if (spectrum.energy > 0.0) {
        spectrum.weightedCentroidHz *= binHz / spectrum.energy;
        spectrum.exponent /= spectrum.energy;
    }
    return spectrum;
}

// Mean square of the filtered wave over [start, end), shifted by the filter's delay and lengthened on both sides to
// whole half periods, as far as the history reaches. A frame before an onset excludes everything after that onset.
double WaveFeatures::meanSquare(std::uint64_t start, std::uint64_t end, double centroidHz) const noexcept {
    const double halfPeriod = 0.5 * sampleRateHz / centroidHz;
    const auto frameLength = static_cast<double>(end - start);
    const double length =
        std::min(std::ceil(frameLength / halfPeriod - 1e-9) * halfPeriod, static_cast<double>(historySamples) - 2.0);
    const double wantedEnd = static_cast<double>(end) + filter_.delaySamples() + 0.5 * (length - frameLength);
    const std::uint64_t heldEnd = hasOnset_ && onset_ >= end ? onset_ : taken_;
    const double last = std::min(wantedEnd, static_cast<double>(heldEnd));
    const double first = last - length;
    double sum = 0.0;
    const auto firstSample = static_cast<std::int64_t>(std::floor(first));
    for (std::int64_t i = std::max<std::int64_t>(0, firstSample); static_cast<double>(i) < last; ++i) {
        const double share = std::min(static_cast<double>(i) + 1.0, last) - std::max(static_cast<double>(i), first);
        const double value = thresholds_[static_cast<std::size_t>(i) % historySamples];
        sum += share * value * value;
    }
    return sum / length;
}

WaveTransient WaveFeatures::transientWithin(std::uint64_t start, std::uint64_t end) noexcept {
    if (!hasOnset_ || onset_ >= end) {
        return {};
    }
    hasOnset_ = false;
    double peak = 0.0;
    double sums = 0.0;
    double differences = 0.0;
    double last = 0.0;
    for (std::uint64_t i = onset_; i < std::min<std::uint64_t>(onset_ + transientSamples, taken_); ++i) {
        const double value = wave_[i % historySamples];
        peak = std::max(peak, std::abs(value));
        sums += (value + last) * (value + last);
        differences += (value - last) * (value - last);
        last = value;
    }
    // For a sinusoid, the sum of neighbouring samples has the amplitude 2 cos(turn / 2) and their difference
    // 2 sin(turn / 2).
    const double turn = 2.0 * std::atan2(std::sqrt(differences), std::sqrt(sums));
    const double ownHz = turn / (2.0 * std::numbers::pi) * sampleRateHz;
    const double frequencyHz = onDevice(ownHz);
    const double amplitude = amplitudeOfIntensity(intensityOfSinusoid(peak, ownHz), frequencyHz);
    return {.offsetSeconds = static_cast<float>(static_cast<double>(std::max(onset_, start) - start) / sampleRateHz),
            .amplitudeMps2 = static_cast<float>(amplitude),
            .frequencyHz = static_cast<float>(frequencyHz)};
}

double WaveFeatures::onDevice(double frequencyHz) const noexcept {
    const double low = options_.minFrequencyHz;
    const double high = options_.maxFrequencyHz;
    const double playedLow = std::max(low, std::min(lowestTextureHz, high));
    const double playedHigh = std::min(high, std::max(highestTextureHz, low));
    const double compression = std::log(playedHigh / playedLow) / std::log(highestTextureHz / lowestTextureHz);
    return std::clamp(playedLow * std::pow(frequencyHz / lowestTextureHz, compression), low, high);
}

std::vector<float> decimated(std::span<const float> wave, std::size_t factor) {
    WaveDecimation decimation(factor);
    const std::size_t delay = factor == 1 ? 0 : WaveDecimation::delaySamples;
    const std::size_t count = wave.size() / factor + delay;
    std::vector<float> slow;
    slow.reserve(count);
    for (std::size_t i = 0; slow.size() < count; ++i) {
        float sample = 0.0F;
        if (decimation.take(i < wave.size() ? wave[i] : 0.0F, sample)) {
            slow.push_back(sample);
        }
    }
    slow.erase(slow.begin(), slow.begin() + static_cast<std::ptrdiff_t>(delay));
    return slow;
}

}  // namespace haptoflow::effects
