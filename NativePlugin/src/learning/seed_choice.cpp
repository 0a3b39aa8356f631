#include "learning/seed_choice.hpp"

#include "dsp/tone_cepstrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace haptoflow::learning {
namespace {

constexpr std::size_t step = 50;
constexpr std::size_t filterSamples = dsp::toneTaps - 1;
constexpr double minimumDistance = 0.05;
/// A stretch that differs from the level law by a larger factor is an outlier.
constexpr double maximumLevelRatio = 2.0;

struct Candidate {
    std::size_t start = 0;
    std::array<double, 3> motion{};
    /// Log speed, log force, direction and time, scaled so that a distance of 1 means different conditions.
    std::array<double, 5> place{};
};

double rmsOf(std::span<const float> wave) {
    double sum = 0.0;
    for (const float value : wave) {
        sum += static_cast<double>(value) * value;
    }
    return std::sqrt(sum / static_cast<double>(wave.size()));
}

std::vector<Candidate> candidatesOf(const recordings::PreparedRecording& recording, const Sliding& sliding,
                                    std::span<const float> unitWave) {
    std::vector<Candidate> candidates;
    for (std::size_t start = step * (1 + filterSamples / step); start < unitWave.size(); start += step) {
        if (!sliding.holds(start - filterSamples, filterSamples + model::seedSamples)) {
            continue;
        }
        const double rms = rmsOf(unitWave.subspan(start, model::seedSamples));
        if (!(rms > 1.0 / maximumLevelRatio && rms < maximumLevelRatio)) {
            continue;
        }
        Candidate each{.start = start, .motion = {}, .place = {}};
        for (std::size_t i = start; i < start + model::seedSamples; ++i) {
            for (std::size_t component = 0; component < each.motion.size(); ++component) {
                each.motion[component] += recording.motion[i][component] / static_cast<double>(model::seedSamples);
            }
        }
        const double speed = std::hypot(each.motion[0], each.motion[1]);
        if (speed < minimumSlidingMps) {
            continue;
        }
        each.place = {2.0 * std::log(speed), 1.4 * std::log(each.motion[2]), 0.5 * each.motion[0] / speed,
                      0.5 * each.motion[1] / speed,
                      0.3 * static_cast<double>(start) / static_cast<double>(unitWave.size())};
        candidates.push_back(each);
    }
    return candidates;
}

double distanceOf(const Candidate& one, const Candidate& other) {
    double sum = 0.0;
    for (std::size_t i = 0; i < one.place.size(); ++i) {
        sum += (one.place[i] - other.place[i]) * (one.place[i] - other.place[i]);
    }
    return std::sqrt(sum);
}

/// Chooses candidates one after the other, each as far as possible from those before; the first is nearest to the
/// middle.
std::vector<Candidate> spreadOut(const std::vector<Candidate>& candidates) {
    Candidate middle;
    for (const Candidate& each : candidates) {
        for (std::size_t i = 0; i < middle.place.size(); ++i) {
            middle.place[i] += each.place[i] / static_cast<double>(candidates.size());
        }
    }
    const auto first =
        std::ranges::min_element(candidates, {}, [&](const Candidate& each) { return distanceOf(each, middle); });
    std::vector<Candidate> chosen{*first};
    std::vector<double> nearest(candidates.size(), std::numeric_limits<double>::infinity());
    while (chosen.size() < maximumLearntSeeds) {
        for (std::size_t i = 0; i < candidates.size(); ++i) {
            nearest[i] = std::min(nearest[i], distanceOf(candidates[i], chosen.back()));
        }
        const auto farthest = std::ranges::max_element(nearest);
        if (*farthest < minimumDistance) {
            break;
        }
        chosen.push_back(candidates[static_cast<std::size_t>(farthest - nearest.begin())]);
    }
    return chosen;
}

dsp::ToneKernel inverseKernel(const model::ToneTable& tone, double speedMps) {
    // The inverse of a minimum-phase filter is the minimum-phase filter with the opposite gains.
    return dsp::toneKernel(
        dsp::toneCepstrum([&](double hertz) { return -tone.gainDb(speedMps, std::max(hertz, 1.0)); }));
}

}  // namespace

std::vector<LearntSeed> chooseSeeds(const recordings::PreparedRecording& recording, const Sliding& sliding,
                                    std::span<const float> unitWave, const model::ToneTable& tone) {
    const std::vector<Candidate> candidates = candidatesOf(recording, sliding, unitWave);
    std::vector<LearntSeed> seeds;
    if (candidates.empty()) {
        return seeds;
    }
    for (const Candidate& each : spreadOut(candidates)) {
        LearntSeed seed;
        seed.start = each.start;
        seed.velocityMps = {each.motion[0], each.motion[1]};
        seed.forceNewtons = each.motion[2];
        if (tone.speedsMps.empty()) {
            std::ranges::copy(unitWave.subspan(each.start, model::seedSamples), seed.samples.begin());
        } else {
            const dsp::ToneKernel kernel = inverseKernel(tone, std::hypot(each.motion[0], each.motion[1]));
            for (std::size_t i = 0; i < model::seedSamples; ++i) {
                double sum = 0.0;
                for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
                    sum += static_cast<double>(kernel[tap]) * unitWave[each.start + i - tap];
                }
                seed.samples[i] = static_cast<float>(sum);
            }
        }
        const double rms = rmsOf(seed.samples);
        if (rms > 0.0 && std::isfinite(rms)) {
            for (float& value : seed.samples) {
                value = static_cast<float>(value / rms);
            }
            seeds.push_back(seed);
        }
    }
    return seeds;
}

}  // namespace haptoflow::learning
