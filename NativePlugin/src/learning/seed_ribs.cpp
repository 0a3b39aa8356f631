#include "learning/seed_ribs.hpp"

#include "inference/gaussian_noise.hpp"
#include "skeleton/rib_rates.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace haptoflow::learning {
namespace {

constexpr std::size_t half = inference::segmentSamples;
static_assert(model::seedSamples == 2 * half);
constexpr std::size_t triedPhases = 16;
/// Runs for each phase; every second one has no previous waveform, so that the network can follow only the phase.
constexpr std::size_t draws = 6;
/// Noise key that no round of the fit uses.
constexpr std::uint64_t noiseRound = std::uint64_t{1} << 40U;

using RibPhase = std::array<double, inference::ribCount>;

float asPhase(double turns) {
    const auto rounded = static_cast<float>(turns - std::floor(turns));
    return rounded < 1.0F ? rounded : 0.0F;
}

class RibPlacer {
public:
    RibPlacer(ClosedLoop& loop, const Embedding& embedding, std::uint64_t key) : loop_(loop), embedding_(embedding) {
        for (std::size_t draw = 0; draw < draws; ++draw) {
            noise_[draw].resize(half);
            inference::fillStandardNormal(
                {.seed = key, .voice = static_cast<std::uint32_t>(draw), .segment = noiseRound}, noise_[draw]);
        }
        for (std::size_t i = 0; i < half; ++i) {
            // Later samples count less, because the phase becomes inaccurate when the tip's speed changes.
            weight_[i] = 0.5 + 0.5 * std::cos(std::numbers::pi * static_cast<double>(i) / static_cast<double>(half));
        }
    }

    [[nodiscard]] RibPhase phaseOf(const LearntSeed& seed) {
        RibPhase phase{};
        for (std::size_t rib = 0; rib < phase.size(); ++rib) {
            const std::size_t first = embedding_.size() - 2 * inference::ribCount + 2 * rib;
            if (embedding_[first] != 0.0F || embedding_[first + 1] != 0.0F) {
                phase[rib] = bestPhase(seed, phase, rib);
            }
        }
        return phase;
    }

private:
    double bestPhase(const LearntSeed& seed, const RibPhase& known, std::size_t rib) {
        const std::span<const float> samples = seed.samples;
        std::vector<inference::SegmentRequest> requests;
        for (std::size_t k = 0; k < triedPhases * draws; ++k) {
            const std::size_t draw = k % draws;
            inference::SegmentRequest request{
                embedding_,
                loop_.motionFrom(seed.start + half, half),
                draw % 2 == 0 ? samples.first<half>() : std::span<const float, half>(silence_),
                std::span<const float>(noise_[draw]).first<half>(),
                {},
                1.0F,
                {}};
            std::array<float, inference::ribCount> turns{};
            std::ranges::transform(known, turns.begin(), asPhase);
            turns[rib] = static_cast<float>(tried(k / draws));
            request.phases = skeleton::phasesOf(request.embedding, request.motion, turns);
            requests.push_back(request);
        }
        std::vector<float> made(requests.size() * half);
        loop_.generate(requests, made);
        std::array<double, triedPhases> similarity{};
        for (std::size_t k = 0; k < requests.size(); ++k) {
            for (std::size_t i = 0; i < half; ++i) {
                similarity[k / draws] += weight_[i] * samples[half + i] * made[k * half + i];
            }
        }
        return tried(static_cast<std::size_t>(std::ranges::max_element(similarity) - similarity.begin()));
    }

    static double tried(std::size_t phase) { return static_cast<double>(phase) / static_cast<double>(triedPhases); }

    ClosedLoop& loop_;
    const Embedding& embedding_;
    std::array<std::vector<float>, draws> noise_;
    std::array<double, half> weight_{};
    std::array<float, half> silence_{};
};

}  // namespace

void placeRibs(std::span<LearntSeed> seeds, ClosedLoop& loop, const Embedding& embedding, std::uint64_t seed) {
    const auto waveNumbers = std::span(embedding).last<2 * inference::ribCount>();
    if (std::ranges::all_of(waveNumbers, [](float value) { return value == 0.0F; })) {
        return;
    }
    RibPlacer placer(loop, embedding, seed);
    for (LearntSeed& each : seeds) {
        each.ribPhase = placer.phaseOf(each);
    }
}

}  // namespace haptoflow::learning
