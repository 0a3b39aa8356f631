#include "effects/wave_decimation.hpp"

#include "dsp/kaiser_window.hpp"

#include <algorithm>
#include <cmath>
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

}  // namespace haptoflow::effects
