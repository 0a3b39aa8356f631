// Extreme scenes and tracker data, from the contact model to the rendered sound of a voice, on each tier of the shipped
// model and on an untrained one.
#include "headless/contact_tracker.hpp"
#include "headless/test_scenes.hpp"
#include "output_checks.hpp"

#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <tuple>

namespace haptoflow::capi::testing {
namespace {

using headless::Box;
using headless::ContactReading;
using headless::ContactTracker;
using headless::Scene;
using headless::TipSample;
using headless::testing::meshOf;
using headless::testing::rawBoxMesh;
using headless::testing::sceneOf;
using headless::testing::surfaceOf;
using headless::testing::turned;

constexpr double updateHz = 90.0;
constexpr double speedMps = 0.25;

struct HardScene {
    std::string name;
    Scene scene;
    std::function<TipSample(int)> sample;
    /// True if the tip slides, so that the case must sound.
    bool sounds = true;
};

/// A stroke to and fro on a face at y = 0.1, half a millimetre deep.
glm::dvec3 stroke(double seconds) {
    const double phase = 2.0 * std::numbers::pi * seconds;
    return {0.04 * std::sin(phase), 0.1005, 0.03 * std::cos(0.7 * phase)};
}

TipSample onFace(int frame) {
    return {frame / updateHz, stroke(frame / updateHz), {}, {}};
}

Scene box(double scale = 1.0) {
    return sceneOf({surfaceOf(Box{scale * glm::dvec3(0.2)})});
}

/// Samples of which every third is changed by `ruin`.
std::function<TipSample(int)> corrupted(const std::function<void(TipSample&)>& corrupt) {
    return [corrupt](int frame) {
        TipSample sample = onFace(frame);
        if (frame % 3 == 2) {
            corrupt(sample);
        }
        return sample;
    };
}

std::function<TipSample(int)> steps(double seconds) {
    return [seconds](int frame) { return TipSample{frame * seconds, stroke(frame / updateHz), {}, {}}; };
}

/// A tip with noise of a tenth of a millimetre around a place.
std::function<TipSample(int)> trembling(const glm::dvec3& place) {
    return [place](int frame) {
        std::minstd_rand random(static_cast<unsigned>(frame + 1));
        std::uniform_real_distribution<double> spread(-1e-4, 1e-4);
        const double x = spread(random);
        const double y = spread(random);
        return TipSample{frame / updateHz, place + glm::dvec3(x, y, spread(random)), {}, {}};
    };
}

headless::testing::RawMesh insideOut() {
    headless::testing::RawMesh mesh = rawBoxMesh({0.1, 0.1, 0.1});
    for (auto& triangle : mesh.triangles) {
        std::swap(triangle[0], triangle[1]);
    }
    return mesh;
}

headless::testing::RawMesh withNeedles() {
    headless::testing::RawMesh mesh = rawBoxMesh({0.1, 0.1, 0.1});
    const auto whole = mesh.triangles;
    for (const auto& [a, b, c] : whole) {
        mesh.triangles.push_back({a, b, b});
        mesh.triangles.push_back({c, c, c});
    }
    return mesh;
}

std::vector<HardScene> hardScenes() {
    const auto meshScene = [](const headless::testing::RawMesh& raw) { return sceneOf({surfaceOf(meshOf(raw))}); };
    headless::Pose longRotation;
    longRotation.rotation = glm::dquat(0.0, 0.0, 7.0, 0.0);
    headless::Pose noRotation;
    noRotation.rotation = glm::dquat(0.0, 0.0, 0.0, 0.0);
    headless::Pose damaged;
    damaged.positionMetres = {headless::testing::nan, 0.0, 0.0};
    const Scene innerCorner =
        sceneOf({surfaceOf(headless::Plane{}), surfaceOf(headless::Plane{}, {{}, turned(-90.0, {0.0, 0.0, 1.0})})});
    return {
        {"TimeStandsStill", box(), steps(0.0), false},
        {"TimeRunsBackwards", box(), steps(-1.0 / updateHz), false},
        {"TimeGoesBackEveryThirdUpdate", box(), corrupted([](TipSample& sample) { sample.timeSeconds -= 1.0; })},
        {"StepsOfAMicrosecond", box(), steps(1e-6), false},
        {"StepsOfTenSeconds", box(), steps(10.0), false},
        {"APauseOfTenSeconds", box(),
         [](int frame) {
             TipSample sample = onFace(frame);
             sample.timeSeconds += frame > 50 ? 10.0 : 0.0;
             return sample;
         }},
        {"TeleportEveryThirdUpdate", box(), corrupted([](TipSample& sample) { sample.positionMetres.x += 5.0; })},
        {"TeleportOnTheSurface", box(),
         [](int frame) {
             TipSample sample = onFace(frame);
             sample.positionMetres.x += frame % 20 < 10 ? 0.05 : -0.05;
             return sample;
         }},
        {"PositionsNotFinite", box(), corrupted([](TipSample& sample) {
             sample.positionMetres = {headless::testing::nan, headless::testing::infinity,
                                      -headless::testing::infinity};
         })},
        {"ForcesNotFinite", box(), corrupted([](TipSample& sample) { sample.forceNewtons = headless::testing::nan; })},
        {"TimesNotFinite", box(),
         corrupted([](TipSample& sample) { sample.timeSeconds = headless::testing::infinity; })},
        {"NormalsFlipped", meshScene(insideOut()), onFace},
        {"NormalsZero", meshScene(withNeedles()), onFace},
        {"RotationNotOfUnitLength", sceneOf({surfaceOf(Box{{0.2, 0.2, 0.2}}, longRotation)}), onFace},
        {"RotationZero", sceneOf({surfaceOf(Box{{0.2, 0.2, 0.2}}, noRotation)}), onFace},
        {"PoseNotFinite", sceneOf({surfaceOf(Box{{0.2, 0.2, 0.2}}, damaged)}), onFace},
        {"ScaleAMillionth", box(1e-6),
         [](int frame) {
             return TipSample{frame / updateHz, glm::dvec3(0.0005 * std::sin(0.9 * frame), 0.0007, 0.0), {}, {}};
         }},
        {"ScaleAMillion", box(1e6),
         [](int frame) {
             TipSample sample = onFace(frame);
             sample.positionMetres.y += 1e5 - 0.1;
             return sample;
         }},
        {"TipOnAnEdge", box(), trembling({0.1, 0.1, 0.03})},
        {"TipOnACorner", box(), trembling({0.1, 0.1, 0.1})},
        {"TipInACorner", innerCorner, trembling({0.0005, 0.0005, 0.0})},
        {"TipInsideAMesh", meshScene(rawBoxMesh({0.05, 0.2, 0.2})),
         [](int frame) {
             const double seconds = frame / updateHz;
             return TipSample{seconds, {speedMps * seconds - 0.15, 0.01 * std::sin(9.0 * seconds), 0.003}, {}, {}};
         }},
        {"TipOverAnEdge", box(),
         [](int frame) {
             const double along = speedMps * frame / updateHz - 0.15;
             return TipSample{
                 frame / updateHz, {std::min(0.05 + along, 0.1005), std::min(0.1005, 0.15 - along), 0.0}, {}, {}};
         }},
    };
}

haptoflow_contact_state contactStateOf(const ContactReading& reading) {
    haptoflow_contact_state state = slidingState();
    state.touching = reading.touching ? 1 : 0;
    state.touch_counter = reading.touchCounter;
    state.velocity_mps[0] = static_cast<float>(reading.tangentialVelocityMps.x);
    state.velocity_mps[1] = static_cast<float>(reading.tangentialVelocityMps.y);
    state.force_newtons = static_cast<float>(reading.forceNewtons);
    state.approach_speed_mps = static_cast<float>(reading.approachSpeedMps);
    return state;
}

class HardSceneTest : public ::testing::TestWithParam<std::tuple<Subject, HardScene>> {};

TEST_P(HardSceneTest, TheOutputIsFiniteBoundedAndEndsWithTheContact) {
    const auto& [subject, hardScene] = GetParam();
    OpenEngine open(*subject.modelPath, false, subject.quality);
    ContactTracker tracker(hardScene.scene);
    std::vector<float> output;
    haptoflow_contact_state state{};
    for (int frame = 0; frame < static_cast<int>(1.2 * updateHz); ++frame) {
        state = contactStateOf(tracker.update(hardScene.sample(frame)));
        appendChecked(output, open.update(state, static_cast<uint32_t>(48000.0 / updateHz)),
                      static_cast<uint32_t>(frame));
    }
    EXPECT_GT(state.touch_counter, 0U) << "the tip touched nothing";
    if (hardScene.sounds) {
        EXPECT_GT(peak(output), perceptibleLevel);
    }
    const haptoflow_voice_statistics statistics = open.statistics();
    EXPECT_EQ(statistics.non_finite_samples, 0U);
    EXPECT_EQ(statistics.failures, 0U);
    EXPECT_EQ(statistics.sanitised, 0U) << "the contact model returned a number that is out of range";
    expectSilenceAfterLiftOff(open, state.touch_counter, output);
    expectNoStep(output);
}

INSTANTIATE_TEST_SUITE_P(OnModel, HardSceneTest, ::testing::Combine(subjects, ::testing::ValuesIn(hardScenes())),
                         subjectAndCaseName);

}  // namespace
}  // namespace haptoflow::capi::testing
