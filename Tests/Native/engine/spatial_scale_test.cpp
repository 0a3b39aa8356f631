#include "engine/range_law.hpp"
#include "engine/rib_phase.hpp"
#include "simulated_device.hpp"
#include "small_library.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

// The spatial scale of a surface: features that are larger by a factor are generated for a speed divided by it, at the
// level of the actual speed.

namespace haptoflow::engine {
namespace {

using testing::FakeGenerator;
using testing::SimulatedDevice;
using testing::sliding;

TEST(SpatialScaleStateTest, ScaleAndTiltAreClampedAndAScaleOfZeroMeansOne) {
    ContactState state;
    state.spatialScale = 0.0F;
    EXPECT_EQ(sanitise(state), 0U);
    EXPECT_EQ(state.spatialScale, 1.0F);
    const std::array<std::pair<float, float>, 5> limited{{{0.1F, 0.25F},
                                                          {-2.0F, 0.25F},
                                                          {100.0F, 4.0F},
                                                          {std::numeric_limits<float>::infinity(), 1.0F},
                                                          {std::numeric_limits<float>::quiet_NaN(), 1.0F}}};
    for (const auto& [given, expected] : limited) {
        state.spatialScale = given;
        EXPECT_EQ(sanitise(state), 1U) << given;
        EXPECT_EQ(state.spatialScale, expected) << given;
    }
    state.toneDbPerOctave = -100.0F;
    EXPECT_EQ(sanitise(state), 1U);
    EXPECT_EQ(state.toneDbPerOctave, -12.0F);
    state.toneDbPerOctave = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(sanitise(state), 1U);
    EXPECT_EQ(state.toneDbPerOctave, 0.0F);
}

TEST(SpatialScaleLawTest, TheNetworkUsesTheScaledSpeedAndTheLevelTheActualSpeed) {
    const testing::SmallLibrary small;
    const Material oak = resolveMaterial(small.ingredients({{0, 1.0F}}));
    const model::ModelHeader& header = small.model.header();
    const RangedMotion larger = applyRangeLaw(header, oak, {0.08F, -0.06F}, 1.0F, 2.0F);
    EXPECT_FLOAT_EQ(larger.motion[0], 0.04F);
    EXPECT_FLOAT_EQ(larger.motion[1], -0.03F);
    EXPECT_FLOAT_EQ(larger.levelMotion[0], 0.08F);
    EXPECT_FLOAT_EQ(larger.levelMotion[1], -0.06F);
    EXPECT_EQ(larger.levelGain, 1.0);
    EXPECT_EQ(larger.readingRate, 1.0);
    // The small model's range ends at 0.4 m/s; beyond it the reading rate grows with the square root of the speed.
    const RangedMotion smaller = applyRangeLaw(header, oak, {0.4F, 0.0F}, 1.0F, 0.25F);
    EXPECT_FLOAT_EQ(smaller.motion[0], 0.4F);
    EXPECT_NEAR(smaller.levelGain, 1.0, 1e-6) << "the actual speed is within the range";
    EXPECT_NEAR(smaller.readingRate, 2.0, 1e-6);
    const RangedMotion fast = applyRangeLaw(header, oak, {0.8F, 0.0F}, 1.0F, 2.0F);
    EXPECT_NEAR(fast.readingRate, 1.0, 1e-6) << "half the speed is within the range";
    EXPECT_NEAR(fast.levelGain, std::sqrt(2.0), 1e-6);
}

class SpatialScaleTest : public ::testing::Test {
protected:
    /// A model with ribs of 0.2 cycles per millimetre along the first axis.
    static model::ModelFile ruledModel() {
        model::testing::ModelBuilder builder;
        std::vector<float> embedding(2 * model::embeddingSize, 0.5F);
        for (std::size_t row = 0; row < 2; ++row) {
            const std::array<float, 4> vectors{0.2F, 0.0F, 0.0F, 0.0F};
            std::ranges::copy(vectors, embedding.begin() + static_cast<std::ptrdiff_t>(row * 64 + 60));
        }
        builder.blobs[0].bytes = model::testing::bytesOf(embedding);
        return model::ModelFile::parse(builder.build());
    }
    static ContactState scaled(float scale) {
        ContactState state = sliding();
        state.spatialScale = scale;
        return state;
    }
    struct Asked {
        float phase = 0.0F;
        std::array<float, 3> motion{};
        std::array<float, 3> levelMotion{};
    };

    /// Turns of the rib phase per sample between two segments.
    [[nodiscard]] double turnsPerSample(const SimulatedDevice& device, std::size_t segment) const {
        const double turns =
            static_cast<double>(requested_[segment].phase) - static_cast<double>(requested_[segment - 1].phase);
        const auto hop = static_cast<double>(device.waveform.seams[segment] - device.waveform.seams[segment - 1]);
        return (turns - std::floor(turns)) / hop;
    }

    model::ModelFile model_ = ruledModel();
    std::vector<Asked> requested_;
    FakeGenerator generator_{[this](const inference::SegmentRequest& request, std::span<float> segment) {
        requested_.push_back({request.phases[0], request.motion, request.levelMotion.value_or(request.motion)});
        std::ranges::copy(request.noise, segment.begin());
    }};
};

TEST_F(SpatialScaleTest, TheRibPitchIsDividedByTheScale) {
    // At 0.1 m/s and 0.2 cycles per millimetre, the tip crosses 20 ribs per second, 0.01 per sample.
    for (const auto& [scale, turns] : {std::pair{1.0F, 0.01}, {2.0F, 0.005}, {0.5F, 0.02}, {4.0F, 0.0025}}) {
        requested_.clear();
        SimulatedDevice device(model_, generator_);
        device.run(0.5, [scale = scale](double) { return scaled(scale); });
        ASSERT_GT(device.waveform.seams.size(), 10U);
        for (std::size_t segment = 5; segment < device.waveform.seams.size(); ++segment) {
            EXPECT_NEAR(turnsPerSample(device, segment), turns, 1e-6) << "scale " << scale;
        }
        EXPECT_FLOAT_EQ(requested_.back().motion[0], 0.1F / scale);
        EXPECT_FLOAT_EQ(requested_.back().levelMotion[0], 0.1F);
    }
}

}  // namespace
}  // namespace haptoflow::engine
