#include "learning/closed_loop.hpp"

#include "skeleton/condition.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>

namespace haptoflow::learning {
namespace {

constexpr std::size_t segment = inference::segmentSamples;
constexpr std::size_t spliceSamples = 4;
constexpr std::size_t correlationSamples = 32;

/// Appends a segment with the engine's splice, whose gains keep the level for any correlation.
void splice(std::span<float, segment> running, std::span<const float, segment> successor) {
    double one = 0.0;
    double other = 0.0;
    double product = 0.0;
    for (std::size_t i = 0; i < correlationSamples; ++i) {
        one += static_cast<double>(running[i]) * running[i];
        other += static_cast<double>(successor[i]) * successor[i];
        product += static_cast<double>(running[i]) * successor[i];
    }
    const double power = std::sqrt(one * other);
    const double correlation = power > 1e-20 ? std::clamp(product / power, 0.0, 1.0) : 1.0;
    for (std::size_t i = 0; i < segment; ++i) {
        if (i >= spliceSamples) {
            running[i] = successor[i];
            continue;
        }
        const double share = static_cast<double>(i + 1) / static_cast<double>(spliceSamples + 1);
        const double rest = 1.0 - share;
        const double norm = std::sqrt(rest * rest + share * share + 2.0 * share * rest * correlation);
        running[i] = static_cast<float>((rest * running[i] + share * successor[i]) / norm);
    }
}

}  // namespace

ClosedLoop::ClosedLoop(inference::SegmentGenerator& generator, const model::ModelHeader& model,
                       const recordings::PreparedRecording& recording, std::span<const float> unitWave)
    : generator_(generator), model_(model), recording_(recording), unitWave_(unitWave) {}

std::array<float, 3> ClosedLoop::limited(const std::array<double, 3>& motion) const {
    const double speed = std::hypot(motion[0], motion[1]);
    const double excess = std::max(1.0, speed / model_.speedMps.maximum);
    return {static_cast<float>(motion[0] / excess), static_cast<float>(motion[1] / excess),
            static_cast<float>(std::clamp(motion[2], model_.forceNewtons.minimum, model_.forceNewtons.maximum))};
}

std::array<float, 3> ClosedLoop::motionFrom(const Chain& chain, std::size_t first, std::size_t count) const {
    if (chain.steadyMotion) {
        const std::array<float, 3>& motion = *chain.steadyMotion;
        return limited({motion[0], motion[1], motion[2]});
    }
    const std::size_t begin = chain.start + first;
    const std::size_t last = std::min(begin + count, recording_.motion.size());
    return limited(recording_.meanMotion(begin, last - begin));
}

std::vector<float> ClosedLoop::run(std::span<const Embedding> embeddings, std::span<const Chain> chains,
                                   const LoopSettings& settings) {
    const std::size_t whole = settings.warmSamples + settings.samples;
    // Before each chain its previous waveform, after it the rest of its last segment.
    const std::size_t stride = segment + whole + segment;
    std::vector<float> waves(chains.size() * stride);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        std::copy_n(unitWave_.begin() + static_cast<std::ptrdiff_t>(chains[c].start - segment), segment,
                    waves.begin() + static_cast<std::ptrdiff_t>(c * stride));
    }
    std::vector<std::array<double, inference::ribCount>> phases(chains.size());
    std::vector<float> previous(chains.size() * segment);
    std::vector<float> noise(chains.size() * segment);
    std::vector<float> made(chains.size() * segment);
    const auto at = [](std::vector<float>& values, std::size_t chain) {
        return std::span<float, segment>(values.data() + chain * segment, segment);
    };
    std::vector<inference::SegmentRequest> requests;
    requests.reserve(chains.size());
    for (std::size_t c = 0; c < chains.size(); ++c) {
        requests.push_back(
            {embeddings[chains[c].embedding], {}, at(previous, c), at(noise, c), {}, settings.impulseGain, 1.0F, {}});
    }
    std::uint64_t hop = 0;
    for (std::size_t start = 0; start < whole; start += settings.hopSamples, ++hop) {
        for (std::size_t c = 0; c < chains.size(); ++c) {
            requests[c].motion = motionFrom(chains[c], start, settings.hopSamples);
            std::array<float, inference::ribCount> cycles{};
            std::ranges::transform(phases[c], cycles.begin(), [](double each) {
                const auto phase = static_cast<float>(each);
                return phase < 1.0F ? phase : 0.0F;
            });
            requests[c].phases = skeleton::phasesOf(requests[c].embedding, requests[c].motion, cycles);
            skeleton::fillStandardNormal(
                {.seed = settings.seed, .voice = chains[c].noise, .segment = settings.round * 4096 + hop},
                at(noise, c));
        }
        for (std::size_t c = 0; c < chains.size(); ++c) {
            std::copy_n(waves.begin() + static_cast<std::ptrdiff_t>(c * stride + start), segment,
                        previous.begin() + static_cast<std::ptrdiff_t>(c * segment));
        }
        generator_.generate(requests, made);
        segments_ += requests.size();
        for (std::size_t c = 0; c < chains.size(); ++c) {
            const auto successor = at(made, c);
            const std::span<float, segment> running(waves.data() + c * stride + segment + start, segment);
            if (start == 0) {
                std::ranges::copy(successor, running.begin());
            } else {
                splice(running, successor);
            }
            const auto& motion = requests[c].motion;
            const auto ratesHz = skeleton::ribRatesHz(requests[c].embedding, static_cast<double>(motion[0]),
                                                      static_cast<double>(motion[1]));
            for (std::size_t rib = 0; rib < ratesHz.size(); ++rib) {
                const double phase = phases[c][rib] + ratesHz[rib] / inference::waveformRateHz *
                                                          static_cast<double>(settings.hopSamples);
                phases[c][rib] = phase - std::floor(phase);
            }
        }
    }
    std::vector<float> result(chains.size() * settings.samples);
    for (std::size_t c = 0; c < chains.size(); ++c) {
        std::copy_n(waves.begin() + static_cast<std::ptrdiff_t>(c * stride + segment + settings.warmSamples),
                    settings.samples, result.begin() + static_cast<std::ptrdiff_t>(c * settings.samples));
    }
    return result;
}

}  // namespace haptoflow::learning
