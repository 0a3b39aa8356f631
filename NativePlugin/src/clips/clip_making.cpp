#include "clips/clip_making.hpp"

#include "effects/carrier_rendering.hpp"
#include "effects/device_loudness.hpp"
#include "effects/wave_features.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace haptoflow::clips {
namespace {

using effects::WaveFeatures;
using effects::WaveFrame;

constexpr double frameSeconds = 0.004;

double shareOf(double amplitudeMps2) noexcept {
    return static_cast<double>(
        effects::deviceShare(effects::DeviceKind::parametric, static_cast<float>(amplitudeMps2)));
}

/// Frames of a wave, or of three rounds of a loop, since the first begins in silence.
std::vector<WaveFrame> framesOf(std::span<const float> waveMps2, const ClipMaking& making) {
    std::vector<float> whole(waveMps2.begin(), waveMps2.end());
    if (making.isLoop) {
        whole.insert(whole.end(), waveMps2.begin(), waveMps2.end());
        whole.insert(whole.end(), waveMps2.begin(), waveMps2.end());
    }
    return effects::framesOf(whole, {.frameSeconds = frameSeconds,
                                     .minFrequencyHz = making.minFrequencyHz,
                                     .maxFrequencyHz = making.maxFrequencyHz});
}

/// Takes a transient out of an amplitude in m/s^2, which keeps the line between the levels before and after it. Returns
/// the amplitude with which a player's pulse has the energy that was taken.
double takeOut(std::vector<ClipPoint>& amplitudeMps2, double onset) {
    const double start = onset - frameSeconds;
    const double end = onset + pulseSeconds;
    const double before = valueAt(amplitudeMps2, start, 0.0);
    const double after = valueAt(amplitudeMps2, end, 0.0);
    double energy = 0.0;
    const auto first = std::ranges::lower_bound(amplitudeMps2, start, {}, &ClipPoint::seconds);
    for (auto point = first; point != amplitudeMps2.end() && point->seconds < end; ++point) {
        const double line = std::lerp(before, after, (point->seconds - start) / (end - start));
        const double kept = std::min(point->value, line);
        energy += frameSeconds * (point->value * point->value - kept * kept);
        point->value = kept;
    }
    return std::sqrt(energy / pulseSeconds);
}

/// A curve's value at both ends of a loop is the same: that between its last and its first point.
void close(std::vector<ClipPoint>& points, double durationSeconds) {
    if (points.empty()) {
        return;
    }
    const double gap = durationSeconds - points.back().seconds + points.front().seconds;
    const double share = gap > 0.0 ? (durationSeconds - points.back().seconds) / gap : 0.0;
    const double seam = std::lerp(points.back().value, points.front().value, share);
    if (points.front().seconds > 0.0) {
        points.insert(points.begin(), {0.0, seam});
    }
    points.push_back({durationSeconds, seam});
}

/// The first and the last value reach to the ends of the clip.
void extend(std::vector<ClipPoint>& points, double durationSeconds) {
    if (points.empty()) {
        return;
    }
    if (points.front().seconds > 0.0) {
        points.insert(points.begin(), {0.0, points.front().value});
    }
    if (points.back().seconds < durationSeconds) {
        points.push_back({durationSeconds, points.back().value});
    }
}

/// Which points stay: from each, as far as a straight line stays within the tolerance of all points passed.
std::vector<std::size_t> keptWithin(std::span<const ClipPoint> points, double ratio, double floor) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<std::size_t> kept{0};
    std::size_t anchor = 0;
    double lowest = -infinity;
    double highest = infinity;
    const auto restartAt = [&](std::size_t index) {
        anchor = index;
        lowest = -infinity;
        highest = infinity;
    };
    for (std::size_t i = 1; i < points.size(); ++i) {
        double run = points[i].seconds - points[anchor].seconds;
        if (anchor + 1 < i) {
            const double slope = (points[i].value - points[anchor].value) / run;
            if (slope < lowest || slope > highest) {
                kept.push_back(i - 1);
                restartAt(i - 1);
                run = points[i].seconds - points[anchor].seconds;
            }
        }
        if (run <= 0.0) {
            // Two points at one time are a jump: both stay.
            if (points[i].value != points[anchor].value) {
                kept.push_back(i);
            }
            restartAt(i);
            continue;
        }
        const double room = std::max(points[i].value, floor) * (ratio - 1.0);
        lowest = std::max(lowest, (points[i].value - room - points[anchor].value) / run);
        highest = std::min(highest, (points[i].value + room - points[anchor].value) / run);
    }
    if (kept.back() != points.size() - 1) {
        kept.push_back(points.size() - 1);
    }
    return kept;
}

double errorDbOf(std::span<const ClipPoint> points, std::span<const ClipPoint> thinned, double floor) {
    double worst = 0.0;
    CurveReader reader(thinned, 0.0);
    for (const ClipPoint& point : points) {
        const double played = std::max(reader.at(point.seconds), floor);
        // At a jump the reader gives the value after it.
        const bool isJump = &point != &points.back() && (&point + 1)->seconds == point.seconds;
        if (!isJump) {
            worst = std::max(worst, std::abs(20.0 * std::log10(played / std::max(point.value, floor))));
        }
    }
    return worst;
}

}  // namespace

HapticClip clipOf(std::span<const float> waveMps2, const ClipMaking& making) {
    HapticClip clip;
    clip.origin = making.origin;
    clip.durationSeconds = static_cast<double>(waveMps2.size()) / WaveFeatures::sampleRateHz;
    if (waveMps2.empty()) {
        throw ClipError("a clip of no samples");
    }
    if (clip.durationSeconds > HapticClip::longestSeconds) {
        throw ClipError("a clip of " + std::to_string(std::llround(clip.durationSeconds)) + " s; the longest is " +
                        std::to_string(std::llround(HapticClip::longestSeconds)) + " s");
    }
    const double shift = making.isLoop ? clip.durationSeconds : 0.0;
    for (const WaveFrame& frame : framesOf(waveMps2, making)) {
        const double start = static_cast<double>(frame.firstSample) / WaveFeatures::sampleRateHz - shift;
        const double half = 0.5 * static_cast<double>(frame.sampleCount) / WaveFeatures::sampleRateHz;
        // The last frame of a wave reaches beyond its end.
        const double middle = making.isLoop ? start + half : std::min(start + half, clip.durationSeconds);
        if (frame.transient.amplitudeMps2 > 0.0F) {
            const double onset = start + static_cast<double>(frame.transient.offsetSeconds);
            if (onset >= 0.0 && onset < clip.durationSeconds) {
                clip.transients.push_back(
                    {onset, shareOf(frame.transient.amplitudeMps2), static_cast<double>(frame.transient.frequencyHz)});
            }
        }
        if (middle >= 0.0 && middle <= clip.durationSeconds) {
            clip.amplitude.push_back({middle, static_cast<double>(frame.amplitudeMps2)});
            clip.frequencyHz.push_back({middle, static_cast<double>(frame.frequencyHz)});
        }
    }
    for (ClipTransient& transient : clip.transients) {
        transient.amplitude = shareOf(takeOut(clip.amplitude, transient.seconds));
    }
    std::ranges::for_each(clip.amplitude, [](ClipPoint& point) { point.value = shareOf(point.value); });
    for (std::vector<ClipPoint>* points : {&clip.amplitude, &clip.frequencyHz}) {
        making.isLoop ? close(*points, clip.durationSeconds) : extend(*points, clip.durationSeconds);
    }
    return clip;
}

std::vector<float> loopOf(std::span<const float> wave, std::size_t shortest, std::size_t longest, std::size_t crossfade,
                          std::size_t step) {
    if (step == 0 || longest < step || crossfade == 0 || shortest < crossfade || longest < shortest ||
        wave.size() < longest + crossfade) {
        throw std::invalid_argument("a loop of " + std::to_string(shortest) + " to " + std::to_string(longest) +
                                    " samples with a crossfade of " + std::to_string(crossfade) + " out of " +
                                    std::to_string(wave.size()));
    }
    const auto correlationAt = [&](std::size_t length) {
        double product = 0.0;
        double energy = 1e-30;
        double energyAfter = 1e-30;
        for (std::size_t i = 0; i < crossfade; ++i) {
            const auto beginning = static_cast<double>(wave[i]);
            const auto after = static_cast<double>(wave[length + i]);
            product += beginning * after;
            energy += beginning * beginning;
            energyAfter += after * after;
        }
        return product / std::sqrt(energy * energyAfter);
    };
    std::size_t length = longest - longest % step;
    double correlation = correlationAt(length);
    for (std::size_t candidate = length; candidate >= shortest + step;) {
        candidate -= step;
        if (const double found = correlationAt(candidate); found > correlation) {
            length = candidate;
            correlation = found;
        }
    }
    std::vector<float> loop(wave.begin(), wave.begin() + static_cast<std::ptrdiff_t>(length));
    for (std::size_t i = 0; i < crossfade; ++i) {
        const double angle = 0.5 * std::numbers::pi * (static_cast<double>(i) + 0.5) / static_cast<double>(crossfade);
        const double rising = std::sin(angle);
        const double falling = std::cos(angle);
        // Energy of the sum of two waves with this correlation; never 0, since both gains are positive.
        const double sum = std::sqrt(std::max(0.05, 1.0 + 2.0 * rising * falling * correlation));
        loop[i] = static_cast<float>(
            (rising * static_cast<double>(wave[i]) + falling * static_cast<double>(wave[length + i])) / sum);
    }
    return loop;
}

Thinned thin(std::span<const ClipPoint> points, double toleranceDb, double floor, std::size_t mostPoints) {
    if (points.size() <= 2) {
        return {.points = {points.begin(), points.end()}};
    }
    const auto keptAt = [&](double decibels) { return keptWithin(points, std::pow(10.0, decibels / 20.0), floor); };
    std::vector<std::size_t> kept = keptAt(toleranceDb);
    if (kept.size() > mostPoints) {
        double tooFine = toleranceDb;
        double coarse = 2.0 * toleranceDb;
        constexpr double coarsestDb = 200.0;
        for (; coarse < coarsestDb && keptAt(coarse).size() > mostPoints; coarse *= 2.0) {
            tooFine = coarse;
        }
        constexpr int halvings = 12;
        for (int i = 0; i < halvings; ++i) {
            const double middle = 0.5 * (tooFine + coarse);
            (keptAt(middle).size() > mostPoints ? tooFine : coarse) = middle;
        }
        kept = keptAt(coarse);
    }
    Thinned result;
    std::ranges::transform(kept, std::back_inserter(result.points), [&](std::size_t index) { return points[index]; });
    result.errorDb = errorDbOf(points, result.points, floor);
    return result;
}

}  // namespace haptoflow::clips
