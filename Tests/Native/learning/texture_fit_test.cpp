#include "learning/texture_fit.hpp"

#include "learning/made_recording.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace haptoflow::learning {
namespace {

/// Gives back the noise and remembers the motions.
class NoiseGenerator final : public inference::SegmentGenerator {
public:
    void levels(std::span<const inference::SegmentRequest>, std::span<float> levelsMps2) override {
        std::ranges::fill(levelsMps2, 1.0F);
    }
    void generate(std::span<const inference::SegmentRequest> requests, std::span<float> segments) override {
        for (const inference::SegmentRequest& request : requests) {
            motions.push_back(request.motion);
            std::ranges::copy(request.noise, segments.begin());
            segments = segments.subspan(inference::segmentSamples);
        }
    }
    std::vector<std::array<float, 3>> motions;
};

TEST(TextureFitTest, SteadyFramesHaveEverySpeedAndForceInTheRecordedDirections) {
    const testing::MadeRecording made({}, {.turns = false});
    const recordings::PreparedRecording recording = recordings::prepareRecording(made.view());
    model::ModelHeader header;
    header.speedMps.maximum = 1.0;
    header.forceNewtons = {.minimum = 0.0, .maximum = 20.0};
    const Sliding sliding = findSliding(recording, header);
    NoiseGenerator generator;
    ClosedLoop loop(generator, header, recording, recording.wave);
    const std::array<float, 2 * inference::ribCount> noRibs{};
    TextureFit fit(loop, recording, sliding, recording.wave, noRibs, 1);
    const std::array speeds{0.02, 0.3};
    const std::array forces{0.4, 1.0, 2.5};
    const std::vector<SpectrumFrame> frames = fit.steadyFrames({}, speeds, forces, 3000);
    for (const double speed : speeds) {
        for (const double force : forces) {
            const auto isHere = [&](const SpectrumFrame& frame) {
                return std::abs(frame.speedMps - speed) < 1e-6 && std::abs(frame.forceNewtons - force) < 1e-6;
            };
            EXPECT_EQ(std::ranges::count_if(frames, isHere) * 6, static_cast<std::ptrdiff_t>(frames.size()));
        }
    }
    ASSERT_FALSE(generator.motions.empty());
    for (const std::array<float, 3>& motion : generator.motions) {
        EXPECT_LT(std::abs(motion[1]), 0.01F * std::abs(motion[0]));
    }
    EXPECT_LE(generator.motions.size(), 3000U);
    double power = 0.0;
    for (const SpectrumFrame& frame : frames) {
        for (const double each : frame.power) {
            power += each / static_cast<double>(frames.size());
        }
    }
    EXPECT_NEAR(power, 1.0, 0.05);
}

}  // namespace
}  // namespace haptoflow::learning
