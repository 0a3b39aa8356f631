#include "dsp/rate_warp.hpp"

#include <algorithm>
#include <cmath>

#include "dsp/fourier_transform.hpp"

namespace haptoflow::dsp {
namespace {

constexpr std::size_t pointsPerSample = 256;  // error of linear interpolation: (0.8 pi / 256)^2 / 8, -98 dB
constexpr auto halfLength = static_cast<double>(RateWarp::halfKernelSamples);
constexpr double attenuationDecibels = 65.0;
constexpr double closedCutoff = 0.8;  // of half the rate
constexpr double closedFromRatio = 1.2;
constexpr double slewPerSample = 0.05;  // 10 ms at 2 kHz
constexpr double settledDistance = 1e-9;
// On the way to 1 the ratio aims this much above 1 until the read position meets a sample.
constexpr double landingExcess = 0.01;
constexpr double landingLimit = 0.02;

double smoothStep(double x) noexcept {
    const double t = std::clamp(x, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace

RateWarp::RateWarp() {
    // Two points past the end, because interpolation at the edge reads one further.
    kernel_.resize(halfKernelSamples * pointsPerSample + 2);
    const double beta = kaiserBeta(attenuationDecibels);
    for (std::size_t i = 0; i < kernel_.size(); ++i) {
        const double u = static_cast<double>(i) / static_cast<double>(pointsPerSample);
        const double window = kaiserWindow(u / halfLength, beta);
        kernel_[i].open = static_cast<float>(normalisedSinc(u) * window);
        kernel_[i].closed = static_cast<float>(closedCutoff * normalisedSinc(closedCutoff * u) * window);
    }
    reset();
}

void RateWarp::setTargetRatio(double ratio) noexcept {
    if (std::isfinite(ratio)) {
        state_.target = std::clamp(ratio, 1.0, maximumRatio);
    }
}

bool RateWarp::isTransparent() const noexcept {
    return state_.isDirect() && state_.target == 1.0;
}

std::size_t RateWarp::inputNeeded(std::size_t outputCount) const noexcept {
    State ahead = state_;
    for (std::size_t i = 0; i < outputCount; ++i) {
        ahead.consumed = ahead.consumedAfterNext();
        ahead.advance();
    }
    return static_cast<std::size_t>(ahead.consumed - state_.consumed);
}

void RateWarp::process(std::span<const float> input, std::span<float> output) noexcept {
    std::size_t next = 0;
    for (float& sample : output) {
        const std::uint64_t needed = state_.consumedAfterNext();
        for (; state_.consumed < needed; ++state_.consumed, ++next) {
            history_[state_.consumed % historyLength] = next < input.size() ? input[next] : 0.0F;
        }
        sample = interpolate();
        state_.advance();
    }
}

double RateWarp::readPosition() const noexcept {
    return static_cast<double>(state_.whole) + state_.fraction;
}

double RateWarp::samplesAhead() const noexcept {
    return static_cast<double>(state_.consumed) - readPosition();
}

void RateWarp::reset() noexcept {
    history_.fill(0.0F);
    state_ = State{};
}

void RateWarp::prime(std::span<const float> past) noexcept {
    reset();
    const std::span<const float> kept = past.last(std::min(past.size(), historyLength));
    std::ranges::copy(kept, history_.begin());
    state_.consumed = kept.size();
    state_.whole = static_cast<std::int64_t>(kept.size());
}

double RateWarp::State::reach() const noexcept {
    return isDirect() ? 0.0 : halfLength * ratio;
}

std::uint64_t RateWarp::State::consumedAfterNext() const noexcept {
    const auto lastNeeded = whole + static_cast<std::int64_t>(std::floor(fraction + reach()));
    return std::max(consumed, static_cast<std::uint64_t>(std::max<std::int64_t>(lastNeeded + 1, 0)));
}

void RateWarp::State::advance() noexcept {
    const double toNextSample = fraction > 0.0 ? 1.0 - fraction : 0.0;
    if (target == 1.0 && ratio - 1.0 <= landingLimit && ratio - 1.0 >= toNextSample) {
        // The next step of this size would pass an input sample: stop on that sample at a ratio of 1.
        whole += fraction > 0.0 ? 2 : 1;
        fraction = 0.0;
        ratio = 1.0;
        return;
    }
    fraction += ratio;
    const double carried = std::floor(fraction);
    fraction -= carried;
    whole += static_cast<std::int64_t>(carried);

    const double goal = target == 1.0 ? 1.0 + landingExcess : target;
    const double slewed = ratio + (goal - ratio) * slewPerSample;
    ratio = std::abs(goal - slewed) < settledDistance ? goal : slewed;
}

float RateWarp::sampleAt(std::int64_t index) const noexcept {
    return index < 0 ? 0.0F : history_[static_cast<std::uint64_t>(index) % historyLength];
}

float RateWarp::interpolate() const noexcept {
    if (state_.isDirect()) {
        return sampleAt(state_.whole);
    }
    const double scale = 1.0 / state_.ratio;
    const double closedShare = smoothStep((state_.ratio - 1.0) / (closedFromRatio - 1.0));
    const double reach = state_.reach();
    const auto first = static_cast<std::int64_t>(std::ceil(state_.fraction - reach));
    const auto last = static_cast<std::int64_t>(std::floor(state_.fraction + reach));
    double sum = 0.0;
    for (std::int64_t offset = first; offset <= last; ++offset) {
        const double distance = std::abs(static_cast<double>(offset) - state_.fraction) * scale;
        const double position = std::min(distance, halfLength) * static_cast<double>(pointsPerSample);
        const auto index = static_cast<std::size_t>(position);
        const double weight = position - static_cast<double>(index);
        const KernelPoint& a = kernel_[index];
        const KernelPoint& b = kernel_[index + 1];
        const double open = a.open + weight * (b.open - a.open);
        const double closed = a.closed + weight * (b.closed - a.closed);
        sum += (open + closedShare * (closed - open)) * sampleAt(state_.whole + offset);
    }
    return static_cast<float>(sum * scale);
}

}  // namespace haptoflow::dsp
