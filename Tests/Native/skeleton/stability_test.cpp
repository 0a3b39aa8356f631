#include "skeleton/skeleton.hpp"
#include "skeleton/skeleton_layout.hpp"
#include "skeleton/skeleton_tensors.hpp"
#include "skeleton_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

// The skeleton on its own output for ten minutes of waveform: it must neither grow nor fall silent, whatever it is
// told.

namespace haptoflow::skeleton::testing {
namespace {

using Wave = std::array<float, segmentSamples>;

// 13.9 ms, a state of a display of 72 Hz.
constexpr std::size_t hop = 28;
constexpr std::size_t tenMinutes = 600 * 2000 / hop;

struct Telling {
    std::array<float, embeddingSize> embedding{};
    Motion motion{};
    Phases phases{};
    float level = 1.0F;
};

/// Mean level in unit scale of the first and of the last minute, in dB. A mean of levels, because a few impulses would
/// decide a mean of powers.
struct Drift {
    double firstDb = 0.0;
    double lastDb = 0.0;
};

class StabilityTest : public ::testing::Test {
protected:
    /// Runs ten minutes; `tell(hop)` says what each segment is made for, `spoil` may change its noise and past.
    template <typename Tell, typename Spoil>
    Drift run(const Skeleton& skeleton, Tell tell, Spoil spoil) {
        Drift drift;
        Wave previousMps2{};
        constexpr std::size_t minute = 60 * 2000 / hop;
        for (std::size_t step = 0; step < tenMinutes; ++step) {
            const Telling told = tell(step);
            Wave noise{};
            std::ranges::generate(noise, [this] { return normal_(random_); });
            spoil(step, noise, previousMps2);
            Wave previous{};
            toUnitScale(previousMps2, told.level, previous);
            Wave segment{};
            skeleton.sketch({.embedding = told.embedding,
                             .motion = told.motion,
                             .phases = told.phases,
                             .previous = previous,
                             .noise = noise},
                            conditionOf(told.embedding, told.motion, told.phases), segment);
            const std::span<const float> played(segment.data(), hop);
            double squares = 0.0;
            for (const float sample : played) {
                squares += static_cast<double>(sample) * static_cast<double>(sample);
            }
            const double levelDb = 10.0 * std::log10(squares / hop + 1e-12) / minute;
            drift.firstDb += step < minute ? levelDb : 0.0;
            drift.lastDb += step + minute >= tenMinutes ? levelDb : 0.0;
            const bool isBounded =
                std::ranges::all_of(segment, [](float sample) { return std::fabs(sample) <= unitLimit; });
            if (!isBounded) {
                ADD_FAILURE() << "not bounded at step " << step;
                return drift;
            }
            std::shift_left(previousMps2.begin(), previousMps2.end(), hop);
            std::ranges::transform(played, previousMps2.end() - hop,
                                   [&told](float sample) { return sample * told.level; });
        }
        return drift;
    }
    template <typename Tell>
    Drift run(const Skeleton& skeleton, Tell tell) {
        return run(skeleton, tell, [](std::size_t, Wave&, Wave&) {});
    }

    float between(float low, float high) { return std::uniform_real_distribution<float>(low, high)(random_); }
    Telling anything(float strength) {
        Telling told;
        std::ranges::generate(told.embedding, [&] { return strength * normal_(random_); });
        told.motion = {between(-0.5F, 0.5F), between(-0.5F, 0.5F), between(0.0F, 5.0F)};
        for (std::size_t family = 0; family < familyCount; ++family) {
            told.phases[family] = between(0.0F, 1.0F);
            told.phases[familyCount + family] = between(-1000.0F, 1000.0F);
        }
        told.level = std::exp(between(-6.0F, 4.0F));
        return told;
    }

    std::mt19937 random_{17};
    std::normal_distribution<float> normal_;
};

TEST_F(StabilityTest, TenMinutesOfOneMaterialNeitherGrowNorFade) {
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
        // Stronger random weights give filters that, once driven to the limit of the past, can stay there.
        const auto skeleton = readSkeleton(read(skeletonModel({.seed = seed, .strength = 0.2F})));
        const Telling told = anything(1.0F);
        double cycles = 0.0;
        const Drift drift = run(*skeleton, [&](std::size_t) {
            Telling now = told;
            now.phases = {static_cast<float>(cycles), 0.0F, 0.0F, 61.3F, 0.0F, 0.0F};
            cycles += 61.3 * hop / 2000.0;
            cycles -= std::floor(cycles);
            return now;
        });
        EXPECT_NEAR(drift.lastDb, drift.firstDb, 0.3) << "seed " << seed;
    }
}

TEST_F(StabilityTest, JumpsOfLabelSpeedPhaseAndLevelAtEveryHopStayBounded) {
    const auto skeleton = readSkeleton(read(skeletonModel({.seed = 5, .strength = 2.0F})));
    (void)run(*skeleton, [&](std::size_t) { return anything(1.0F); });
}

TEST_F(StabilityTest, BlendsAndEmbeddingsFarOutsideTheLearntOnesStayBounded) {
    const auto skeleton = readSkeleton(read(skeletonModel({.seed = 6, .strength = 2.0F})));
    const Telling one = anything(1.0F);
    const Telling other = anything(1.0F);
    (void)run(*skeleton, [&](std::size_t step) {
        Telling told = one;
        // From one to the other, and ten times as far.
        const float share = static_cast<float>(step % 1000) / 100.0F;
        for (std::size_t i = 0; i < embeddingSize; ++i) {
            told.embedding[i] += share * (other.embedding[i] - one.embedding[i]);
        }
        return told;
    });
    (void)run(*skeleton, [&](std::size_t) { return anything(1e6F); });
}

TEST_F(StabilityTest, TheLevelIsFiniteForEveryMotionAndLearntEmbedding) {
    const auto level = readLevelModel(read(skeletonModel({.seed = 8})));
    for (int trial = 0; trial < 10000; ++trial) {
        const Telling told = anything(10.0F);
        EXPECT_TRUE(std::isfinite(level->logLevel(told.embedding, told.motion)));
    }
}

}  // namespace
}  // namespace haptoflow::skeleton::testing
