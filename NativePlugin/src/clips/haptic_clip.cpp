#include "clips/haptic_clip.hpp"

#include "effects/device_loudness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace haptoflow::clips {
namespace {

/// The acceleration whose share of a device with amplitude and frequency is this.
double accelerationOfShare(double share) noexcept {
    constexpr double largestMps2 = 1000.0;
    double low = 0.0;
    double high = largestMps2;
    constexpr int halvings = 40;
    for (int i = 0; i < halvings; ++i) {
        const double middle = 0.5 * (low + high);
        const auto played =
            static_cast<double>(effects::deviceShare(effects::DeviceKind::parametric, static_cast<float>(middle)));
        (played < share ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

/// `accelerationOfShare` from a table, since a clip asks once for each sample. Above the last entry the law is so flat
/// that a share says nothing any more.
class AccelerationTable {
public:
    AccelerationTable() {
        for (std::size_t i = 0; i < values_.size(); ++i) {
            values_[i] = accelerationOfShare(largestShare * static_cast<double>(i) / steps);
        }
    }

    [[nodiscard]] double at(double share) const noexcept {
        const double place = std::clamp(share / largestShare, 0.0, 1.0) * steps;
        const auto index = std::min(static_cast<std::size_t>(place), values_.size() - 2);
        return std::lerp(values_[index], values_[index + 1], place - static_cast<double>(index));
    }

private:
    static constexpr double largestShare = 0.95;
    static constexpr double steps = 1000.0;
    std::vector<double> values_ = std::vector<double>(static_cast<std::size_t>(steps) + 1);
};

/// Renders carrier and transients; `scale` turns a share into the unit of the result.
template <typename Scale>
std::vector<float> render(const HapticClip& clip, double rateHz, double minFrequencyHz, double maxFrequencyHz,
                          const Scale& scale) {
    if (!(rateHz >= 2000.0 && rateHz <= 192000.0)) {
        throw std::invalid_argument("rate " + std::to_string(rateHz) + " Hz; expected 2000 to 192000");
    }
    if (!(minFrequencyHz > 0.0 && minFrequencyHz <= maxFrequencyHz && maxFrequencyHz <= 1000.0)) {
        throw std::invalid_argument("frequency range of the device; expected 0 < minimum <= maximum <= 1000 Hz");
    }
    const auto onDevice = [&](double frequencyHz) { return std::clamp(frequencyHz, minFrequencyHz, maxFrequencyHz); };
    std::vector<float> wave(static_cast<std::size_t>(std::llround(clip.durationSeconds * rateHz)));
    CurveReader amplitude(clip.amplitude, 0.0);
    CurveReader frequency(clip.frequencyHz, usualFrequencyHz);
    double cycles = 0.0;
    for (std::size_t i = 0; i < wave.size(); ++i) {
        const double seconds = static_cast<double>(i) / rateHz;
        cycles = std::fmod(cycles + onDevice(frequency.at(seconds)) / rateHz, 1.0);
        wave[i] = static_cast<float>(scale(amplitude.at(seconds)) * std::sin(2.0 * std::numbers::pi * cycles));
    }
    for (const ClipTransient& transient : clip.transients) {
        const double step = onDevice(transient.frequencyHz) / rateHz;
        const double peak = scale(transient.amplitude);
        const auto first = static_cast<std::size_t>(std::ceil(transient.seconds * rateHz));
        const std::size_t last = std::min(wave.size(), first + static_cast<std::size_t>(pulseSeconds * rateHz));
        for (std::size_t i = first; i < last; ++i) {
            wave[i] +=
                static_cast<float>(peak * std::sin(2.0 * std::numbers::pi * static_cast<double>(i - first) * step));
        }
    }
    return wave;
}

}  // namespace

double CurveReader::at(double seconds) noexcept {
    if (points_.empty()) {
        return outside_;
    }
    while (next_ < points_.size() && points_[next_].seconds <= seconds) {
        ++next_;
    }
    if (next_ == 0) {
        return points_.front().value;
    }
    if (next_ == points_.size()) {
        return points_.back().value;
    }
    const ClipPoint& from = points_[next_ - 1];
    const ClipPoint& to = points_[next_];
    return std::lerp(from.value, to.value, (seconds - from.seconds) / (to.seconds - from.seconds));
}

double valueAt(std::span<const ClipPoint> points, double seconds, double outside) noexcept {
    if (points.empty()) {
        return outside;
    }
    const auto next = std::ranges::upper_bound(points, seconds, {}, &ClipPoint::seconds);
    // The reader needs no more than the two points around the time.
    const auto first = next == points.begin() ? next : next - 1;
    return CurveReader(std::span(first, std::min(next + 1, points.end())), outside).at(seconds);
}

std::vector<float> playedWave(const HapticClip& clip, double rateHz, double minFrequencyHz, double maxFrequencyHz) {
    std::vector<float> wave = render(clip, rateHz, minFrequencyHz, maxFrequencyHz, [](double share) { return share; });
    std::ranges::for_each(wave, [](float& sample) { sample = std::clamp(sample, -1.0F, 1.0F); });
    return wave;
}

std::vector<float> waveOf(const HapticClip& clip, double rateHz) {
    static const AccelerationTable accelerations;
    return render(clip, rateHz, 1.0, 1000.0, [](double share) { return accelerations.at(share); });
}

}  // namespace haptoflow::clips
