#include "learning/learner.hpp"

#include "dsp/tone_cepstrum.hpp"
#include "inference/gaussian_noise.hpp"
#include "inference/tier_generator.hpp"
#include "learning/made_recording.hpp"
#include "model/material_file.hpp"
#include "model/model_file.hpp"
#include "skeleton/rib_rates.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <string>
#include <vector>

// The seeds of a learnt material, with which touches begin if the model has no skeleton.

namespace haptoflow::learning {
namespace {

using testing::MadeRecording;

/// Generates noise and the ribs of the first wave vector, at a phase that learning has to find.
class RibGenerator final : public inference::SegmentGenerator {
public:
    static constexpr double ribTurns = 0.3;

    void levels(std::span<const inference::SegmentRequest> requests, std::span<float> levelsMps2) override {
        std::ranges::transform(requests, levelsMps2.begin(),
                               [](const auto& request) { return request.levelMps2.value_or(1.0F); });
    }
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        std::vector<float> scale(requests.size());
        levels(requests, scale);
        for (std::size_t r = 0; r < requests.size(); ++r) {
            const skeleton::Phases& phases = requests[r].phases;
            const double rateHz = phases[3];
            for (std::size_t i = 0; i < inference::segmentSamples; ++i) {
                const double turns = phases[0] - ribTurns + rateHz * static_cast<double>(i) / inference::waveformRateHz;
                const double ribs =
                    rateHz == 0.0 ? 0.0 : std::numbers::sqrt2 * std::cos(2.0 * std::numbers::pi * turns);
                segments[r * inference::segmentSamples + i] =
                    scale[r] * (0.5F * requests[r].noise[i] + static_cast<float>(ribs));
            }
        }
    }
};

class LearntSeedsTest : public ::testing::Test {
protected:
    LearntMaterial learn(const MadeRecording& made) { return learnMaterial(made.view(), model_, generator_, brief()); }

    static LearningSettings brief() { return testing::briefSettings(1000); }

    /// The segment that the generator makes after a seed's first 200 samples, at the seed's own motion.
    std::vector<float> continuation(const model::MaterialFile& material, const model::MaterialSeed& seed,
                                    std::uint32_t draw) {
        constexpr std::size_t half = inference::segmentSamples;
        std::vector<float> noise(half);
        std::vector<float> played(half);
        inference::fillStandardNormal({.seed = 5, .voice = draw, .segment = 0}, noise);
        std::array<inference::SegmentRequest, 1> request{
            {{material.embedding,
              {static_cast<float>(seed.velocityMps[0]), static_cast<float>(seed.velocityMps[1]),
               static_cast<float>(seed.forceNewtons)},
              std::span<const float, half>(seed.samples.data(), half),
              std::span<const float, half>(noise.data(), half),
              {},
              1.0F,
              {}}}};
        const std::array turns{static_cast<float>(seed.ribPhase[0]), static_cast<float>(seed.ribPhase[1])};
        request[0].phases = skeleton::phasesOf(request[0].embedding, request[0].motion, turns);
        generator_.generate(request, played);
        return played;
    }

    model::ModelFile model_ = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    RibGenerator generator_;
};

/// Fundamental of the ribs along the material's first axis, in consecutive samples at the seed's speed.
std::complex<double> fundamentalOf(std::span<const float> wave, const model::MaterialFile& material,
                                   const model::MaterialSeed& seed) {
    const double turns = 1000.0 / inference::waveformRateHz * material.embedding[60] * seed.velocityMps[0];
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < wave.size(); ++i) {
        sum += static_cast<double>(wave[i]) * std::polar(1.0, -2.0 * std::numbers::pi * turns * static_cast<double>(i));
    }
    return sum;
}

TEST_F(LearntSeedsTest, AMaterialOfAModelWithoutASkeletonHasEightSeeds) {
    const LearntMaterial learnt = learn(MadeRecording({}, {}));
    EXPECT_EQ(model::parseMaterial(learnt.materialJson).seeds.size(), 8U);
    EXPECT_EQ(learnt.report.seeds, 8U);
    EXPECT_EQ(nlohmann::json::parse(reportJson(learnt.report)).at("seeds"), 8);
}

TEST_F(LearntSeedsTest, AMaterialOfAModelWithASkeletonHasNone) {
    const auto model = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/skeleton.haptoflow");
    const auto sketch = inference::makeGenerator(nullptr, model, *model.findTier("sketch"), {}, 64);
    for (const std::array<double, 2> ribs : {std::array{0.0, 0.0}, std::array{0.8, 0.45}}) {
        const MadeRecording made({.ribs = ribs, .ribShare = 0.5}, {});
        const LearntMaterial learnt = learnMaterial(made.view(), model, *sketch, brief());
        EXPECT_FALSE(nlohmann::json::parse(learnt.materialJson).contains("seeds"));
        EXPECT_NO_THROW(model::requireSpace(model::parseMaterial(learnt.materialJson), model.header()));
        EXPECT_FALSE(nlohmann::json::parse(reportJson(learnt.report)).contains("seeds"));
    }
}

TEST_F(LearntSeedsTest, AnEvenMotionStillGivesFourSeeds) {
    MadeRecording made({}, {.minimumSpeedMps = 0.08, .maximumSpeedMps = 0.08});
    made.velocity.clear();
    made.force.clear();
    made.constantVelocity = {0.08, 0.0};
    made.constantForce = 0.8;
    EXPECT_GE(model::parseMaterial(learn(made).materialJson).seeds.size(), 4U);
}

TEST_F(LearntSeedsTest, ASeedWithTheToneEqualsTheRecording) {
    const MadeRecording made({.resonanceHz = 90.0}, {}, 2000.0);
    const LearntMaterial learnt = learn(made);
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    const nlohmann::json json = nlohmann::json::parse(learnt.materialJson);
    model::ToneTable tone;
    tone.speedsMps = json["tone"]["speeds_mps"].get<std::vector<double>>();
    tone.frequenciesHz = json["tone"]["frequencies_hz"].get<std::vector<double>>();
    tone.gainsDb = json["tone"]["gains_db"].get<std::vector<std::vector<double>>>();
    const model::MaterialSeed& seed = material.seeds[0];
    const double speed = std::hypot(seed.velocityMps[0], seed.velocityMps[1]);
    const dsp::ToneKernel kernel =
        dsp::toneKernel(dsp::toneCepstrum([&](double hertz) { return tone.gainDb(speed, std::max(hertz, 1.0)); }));
    std::vector<double> heard;
    for (std::size_t i = dsp::toneTaps; i < seed.samples.size(); ++i) {
        double sum = 0.0;
        for (std::size_t tap = 0; tap < kernel.size(); ++tap) {
            sum += static_cast<double>(kernel[tap]) * seed.samples[i - tap];
        }
        heard.push_back(sum);
    }
    // The same wave must occur somewhere in the recording.
    double best = 0.0;
    for (std::size_t start = 0; start + heard.size() <= made.acceleration.size(); ++start) {
        double product = 0.0;
        double one = 0.0;
        double other = 0.0;
        for (std::size_t i = 0; i < heard.size(); ++i) {
            const double value = made.acceleration[start + i];
            product += heard[i] * value;
            one += heard[i] * heard[i];
            other += value * value;
        }
        best = std::max(best, product / std::sqrt(one * other));
    }
    EXPECT_GT(best, 0.97);
}

TEST_F(LearntSeedsTest, ATouchThatStartsFromASeedContinuesTheRibsInPhase) {
    const MadeRecording made({.resonanceHz = 400.0, .ribs = {0.8, 0.45}, .ribShare = 0.9},
                             {.seconds = 12.0, .minimumSpeedMps = 0.05, .maximumSpeedMps = 0.15, .strokeSeconds = 0.7});
    const LearntMaterial learnt = learn(made);
    const model::MaterialFile material = model::parseMaterial(learnt.materialJson);
    ASSERT_GE(material.seeds.size(), 4U);
    // Similarity of the ribs played and recorded: 1 for equal phases, -1 for a difference of half a rib.
    const auto similarity = [&](double shiftTurns) {
        double together = 0.0;
        double most = 0.0;
        for (model::MaterialSeed seed : material.seeds) {
            const std::complex<double> recorded = fundamentalOf(std::span(seed.samples).subspan(200), material, seed);
            seed.ribPhase[0] = std::fmod(seed.ribPhase[0] + shiftTurns, 1.0);
            for (std::uint32_t draw = 0; draw < 16; ++draw) {
                const std::complex<double> played = fundamentalOf(continuation(material, seed, draw), material, seed);
                together += (played * std::conj(recorded)).real();
                most += std::abs(played) * std::abs(recorded);
            }
        }
        return together / most;
    };
    const double placed = similarity(0.0);
    EXPECT_GT(placed, 0.6);
    EXPECT_LT(similarity(0.5), 0.5 * placed) << "the continuation does not follow the phase";
}

TEST_F(LearntSeedsTest, SeedsOfASurfaceWithoutRibsHaveNoPhase) {
    const nlohmann::json json = nlohmann::json::parse(learn(MadeRecording({}, {})).materialJson);
    ASSERT_FALSE(json.at("seeds").empty());
    for (const nlohmann::json& seed : json.at("seeds")) {
        EXPECT_FALSE(seed.contains("rib_phase"));
    }
}

}  // namespace
}  // namespace haptoflow::learning
