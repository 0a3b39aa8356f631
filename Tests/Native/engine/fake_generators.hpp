#pragma once

#include "inference/segment_generator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>
#include <utility>

namespace haptoflow::engine::testing {

/// Generates segments with a function of the request and counts its calls.
class FakeGenerator final : public inference::SegmentGenerator {
public:
    using Answer = std::function<void(const inference::SegmentRequest&, std::span<float>)>;
    explicit FakeGenerator(Answer answer, float levelMps2 = 1.0F) : answer_(std::move(answer)), levelMps2_(levelMps2) {}

    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        ++rounds;
        for (std::size_t i = 0; i < requests.size(); ++i) {
            ++generated;
            answer_(requests[i], segments.subspan(i * inference::segmentSamples, inference::segmentSamples));
        }
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        std::fill_n(levelsMps2.begin(), requests.size(), levelMps2_);
    }
    int rounds = 0;
    int generated = 0;

private:
    Answer answer_;
    float levelMps2_;
};

/// A tone with an amplitude, and a level at touch-down, of 10 m/s^2 per m/s and N, so that the output shows the motion
/// of the request.
class MotionGenerator final : public inference::SegmentGenerator {
public:
    [[nodiscard]] static float levelMps2(const std::array<float, 3>& motion) {
        return 10.0F * std::hypot(motion[0], motion[1]) * motion[2];
    }
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        for (std::size_t i = 0; i < requests.size(); ++i) {
            for (std::size_t sample = 0; sample < inference::segmentSamples; ++sample) {
                const double phase = 2.0 * std::numbers::pi * 100.0 * static_cast<double>(sample) / 2000.0;
                segments[i * inference::segmentSamples + sample] =
                    std::numbers::sqrt2_v<float> * levelMps2(requests[i].motion) * static_cast<float>(std::sin(phase));
            }
        }
    }
    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levels) override {
        std::ranges::transform(requests, levels.begin(), [](const auto& each) { return levelMps2(each.motion); });
    }
};

inline constexpr double toneHz = 100.0;

/// Continues a 100 Hz tone of amplitude 1, with the phase and direction of the last two samples; after silence, it
/// starts at phase zero.
inline void continueTone(const inference::SegmentRequest& request, std::span<float> segment) {
    const double step = 2.0 * std::numbers::pi * toneHz / inference::waveformRateHz;
    const double before = request.previous[inference::segmentSamples - 2];
    const double last = request.previous[inference::segmentSamples - 1];
    // The phase p from sin(p) and sin(p - step).
    const double cosine = (last * std::cos(step) - before) / std::sin(step);
    const double phase = std::abs(last) + std::abs(cosine) < 1e-6 ? 0.0 : std::atan2(last, cosine);
    for (std::size_t i = 0; i < segment.size(); ++i) {
        segment[i] = static_cast<float>(std::sin(phase + step * static_cast<double>(i + 1)));
    }
}

inline void whiteNoise(const inference::SegmentRequest& request, std::span<float> segment) {
    std::ranges::copy(request.noise, segment.begin());
}

}  // namespace haptoflow::engine::testing
