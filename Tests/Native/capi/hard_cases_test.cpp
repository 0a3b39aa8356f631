// Extreme inputs of a hand, a scene or a caller, on each tier of the shipped model and on an untrained one. In every
// case the output is finite, within +-1 and without a step, and it is silent within a block and 5 ms after the end of
// contact.

#include "open_engine.hpp"

#include "headless/contact_tracker.hpp"
#include "headless/test_scenes.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <tuple>

namespace haptoflow::capi::testing {
namespace {

/// -60 dB.
constexpr float silence = 0.001F;
/// 0.04 m/s^2 at the default full scale: four times the fingertip's lowest detection threshold.
constexpr float perceptibleLevel = 0.0002F;

/// The signal before the limiter, whose curve is a hyperbola from the knee at 0.7 towards 1.
std::vector<float> unlimited(const std::vector<float>& output) {
    constexpr float knee = 0.7F;
    constexpr float headroom = 1.0F - knee;
    std::vector<float> given = output;
    for (float& sample : given) {
        const float magnitude = std::abs(sample);
        if (magnitude > knee) {
            sample = std::copysign(knee - headroom + headroom * headroom / (1.0F - magnitude), sample);
        }
    }
    return given;
}

/// Expects that the signal, from its beginning, has no step larger than resampler and gate can produce.
void expectNoStep(const std::vector<float>& output) {
    const std::vector<float> wave = unlimited(output);
    EXPECT_LE(largestStepFrom(0.0F, wave), haptoflow::testing::steepestStep(48000.0) * peak(wave));
}

/// Lifts off and appends the remaining output: below -60 dB after a block and 5 ms, and exactly zero after that.
void expectSilenceAfterLiftOff(OpenEngine& open, uint32_t touchCounter, std::vector<float>& output) {
    const std::vector<float> fade = open.update(liftedState(touchCounter), 256 + 240);
    const std::vector<float> end = open.render(4800);
    EXPECT_LT(peak(std::span(fade).subspan(256)), silence) << "after the end of contact";
    EXPECT_EQ(peak(end), 0.0F) << "after the end of contact";
    output.insert(output.end(), fade.begin(), fade.end());
    output.insert(output.end(), end.begin(), end.end());
}

/// Appends a part of the output after checking that it is finite and within +-1.
void appendChecked(std::vector<float>& output, const std::vector<float>& part, uint32_t update) {
    EXPECT_TRUE(allFinite(part)) << "update " << update;
    EXPECT_LE(peak(part), 1.0F) << "update " << update;
    output.insert(output.end(), part.begin(), part.end());
}

/// A model and a quality for hard cases.
struct Subject {
    const char* name;
    const std::string* modelPath;
    haptoflow_quality quality;
};

const auto subjects = ::testing::Values(Subject{"ShippedDraft", &defaultModelPath, HAPTOFLOW_QUALITY_DRAFT},
                                        Subject{"ShippedStandard", &defaultModelPath, HAPTOFLOW_QUALITY_STANDARD},
                                        Subject{"ShippedSketch", &defaultModelPath, HAPTOFLOW_QUALITY_SKETCH},
                                        Subject{"Untrained", &tinyModelPath, HAPTOFLOW_QUALITY_DRAFT});

/// The test name of a subject and a named case.
const auto subjectAndCaseName = [](const auto& parameters) {
    return std::string(std::get<0>(parameters.param).name) + std::get<1>(parameters.param).name;
};

using State = haptoflow_contact_state;

struct HardCase {
    std::string name;
    /// The contact state of an update.
    std::function<State(uint32_t)> state;
    double updateHz = 72.0;
    /// True if fields must be counted as sanitised.
    bool isCorrupted = false;
    /// If above 1, this many states are published before each block.
    uint32_t statesOfABlock = 1;
    /// How often a touch must begin to sound; 0 if nothing may sound.
    uint32_t onsets = 1;
};

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

std::function<State(uint32_t)> steady(float speedMps, float forceNewtons) {
    return [=](uint32_t) { return slidingState(speedMps, forceNewtons); };
}

/// States of which every third is changed by `ruin`.
std::function<State(uint32_t)> corrupted(const std::function<void(State&)>& corrupt) {
    return [corrupt](uint32_t update) {
        State state = slidingState();
        if (update % 3 == 2) {
            corrupt(state);
        }
        return state;
    };
}

std::function<State(uint32_t)> everyField(float value) {
    return corrupted([value](State& state) {
        state.velocity_mps[0] = value;
        state.velocity_mps[1] = value;
        state.force_newtons = value;
        state.approach_speed_mps = value;
        state.weights[0] = value;
    });
}

State blend(std::initializer_list<std::pair<uint32_t, float>> entries) {
    State state = slidingState();
    state.label_count = 0;
    for (const auto& [label, weight] : entries) {
        state.labels[state.label_count] = label;
        state.weights[state.label_count] = weight;
        ++state.label_count;
    }
    return state;
}

std::function<State(uint32_t)> blended(std::initializer_list<std::pair<uint32_t, float>> entries) {
    return [state = blend(entries)](uint32_t) { return state; };
}

/// A tip that slides, in a state of its own for each update.
std::function<State(uint32_t)> sliding(const std::function<void(State&, uint32_t)>& change) {
    return [change](uint32_t update) {
        State state = slidingState();
        change(state, update);
        return state;
    };
}

std::vector<HardCase> hardCases() {
    // Speeds that become 0 stop every third update: the first stop begins a touch, and 28 resume it.
    constexpr uint32_t stops = 29;
    std::vector<HardCase> cases{
        {.name = "VelocityZero", .state = steady(0.0F, 1.0F), .onsets = 0},
        {.name = "OneMillimetreASecond", .state = steady(0.001F, 1.0F), .onsets = 0},
        {"OneAndAHalfMetresASecond", steady(1.5F, 1.0F)},
        {"TwentyMetresASecond", steady(20.0F, 1.0F)},
        {"ForceZero", steady(0.1F, 0.0F)},
        {"OneMillinewton", steady(0.1F, 0.001F)},
        {"FiveNewtons", steady(0.1F, 5.0F)},
        {"AKilonewton", steady(0.1F, 1000.0F)},
        {.name = "NanInEveryField", .state = everyField(nan), .isCorrupted = true, .onsets = stops},
        {.name = "InfinityInEveryField", .state = everyField(infinity), .isCorrupted = true, .onsets = stops},
        {.name = "MinusInfinityInEveryField", .state = everyField(-infinity), .isCorrupted = true, .onsets = stops},
        {"LargestFloatInEveryField", everyField(std::numeric_limits<float>::max()), 72.0, true},
        {.name = "DenormalsInEveryField", .state = everyField(denormal), .onsets = stops},
        {"NegativeForce", corrupted([](State& state) { state.force_newtons = -3.0F; }), 72.0, true},
        {"WeightsZero", blended({{0, 0.0F}, {1, 0.0F}})},
        {"WeightsNegative", blended({{0, -1.0F}, {1, 0.5F}}), 72.0, true},
        {"WeightsNotSummingToOne", blended({{0, 0.9F}, {1, 0.8F}, {2, 0.7F}})},
        {"LabelsUnknown", blended({{4000000000U, 1.0F}, {77777, 1.0F}})},
        {"LabelCountAboveTheLimit", corrupted([](State& state) { state.label_count = 4000000000U; }), 72.0, true},
        {"NoLabelAtAll", blended({})},
        {"LabelSwitchedEveryUpdate", sliding([](State& state, uint32_t update) { state.labels[0] = update % 3; })},
        {"DirectionReversedEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.3F : -0.3F); }},
        {"SpeedJumpsEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.004F : 18.0F); }},
        {"ForceJumpsEveryUpdate", [](uint32_t update) { return slidingState(0.1F, update % 2 == 0 ? 0.01F : 900.0F); }},
        {"PlaceSurfaceAndAxesThrownAboutEveryUpdate", sliding([](State& state, uint32_t update) {
             const auto angle = static_cast<float>(update);
             state.velocity_mps[0] = update % 2 == 0 ? 0.3F : -0.05F;
             state.has_place = 1;
             state.surface_seed = update % 3;
             state.place_metres[0] = 9000.0F * std::sin(7.0F * angle);
             state.place_metres[1] = std::sin(3.0F * angle);
             state.first_axis[0] = std::cos(angle);
             state.first_axis[1] = std::sin(angle);
             state.second_axis[2] = 1.0F;
         })},
        // Lifted and touching alternate: 43 of 86 updates are touch-downs.
        {.name = "ContactToggledEveryUpdate",
         .state = sliding([](State& state, uint32_t update) {
             state.touching = update % 2;
             state.touch_counter = (update + 1) / 2;
         }),
         .onsets = 43},
        // In one block the tip touches, lifts and touches again; in the next it lifts, taps and lifts.
        {.name = "ContactToggledFourTimesABlock",
         .state = sliding([](State& state, uint32_t update) {
             constexpr std::array<uint32_t, 8> touching{0, 1, 0, 1, 1, 0, 1, 0};
             constexpr std::array<uint32_t, 8> touchDowns{0, 1, 1, 2, 2, 2, 3, 3};
             state.touching = touching[update % 8];
             state.touch_counter = 3 * (update / 8) + touchDowns[update % 8];
         }),
         .updateHz = 750.0,
         .statesOfABlock = 4,
         .onsets = 225},
        {.name = "TouchCounterAnewEveryUpdate",
         .state = sliding([](State& state, uint32_t update) { state.touch_counter = update + 1; }),
         .onsets = 86},
    };
    for (const double hertz : {30.0, 45.0, 72.0, 90.0, 120.0, 250.0, 500.0, 1000.0}) {
        cases.push_back({"UpdateRate" + std::to_string(static_cast<int>(hertz)), steady(0.2F, 1.0F), hertz});
    }
    return cases;
}

class HardCaseTest : public ::testing::TestWithParam<std::tuple<Subject, HardCase>> {
protected:
    /// The output of so many updates of the case; checks that each is finite and bounded.
    static std::vector<float> play(OpenEngine& open, const HardCase& hardCase, uint32_t updates) {
        const auto frames = static_cast<uint32_t>(hardCase.statesOfABlock * 48000.0 / hardCase.updateHz);
        std::vector<float> output;
        for (uint32_t update = 0; update < updates; update += hardCase.statesOfABlock) {
            std::vector<float> part;
            if (hardCase.statesOfABlock == 1) {
                part = open.update(hardCase.state(update), frames);
            } else {
                for (uint32_t i = 0; i < hardCase.statesOfABlock; ++i) {
                    open.publish(hardCase.state(update + i));
                }
                part = open.render(frames);
                open.step();
            }
            appendChecked(output, part, update);
        }
        return output;
    }
};

TEST_P(HardCaseTest, TheOutputIsFiniteBoundedAndEndsWithTheContact) {
    const auto& [subject, hardCase] = GetParam();
    OpenEngine open(*subject.modelPath, false, subject.quality);
    const auto updates = static_cast<uint32_t>(1.2 * hardCase.updateHz);
    std::vector<float> output = play(open, hardCase, updates);
    const haptoflow_voice_statistics statistics = open.statistics();
    EXPECT_EQ(statistics.non_finite_samples, 0U) << "an invalid number reached the limiter";
    EXPECT_EQ(statistics.failures, 0U);
    EXPECT_EQ(statistics.sanitised > 0, hardCase.isCorrupted);
    if (hardCase.onsets == 0) {
        EXPECT_EQ(peak(output), 0.0F);
        EXPECT_EQ(statistics.onsets, 0U);
        EXPECT_EQ(statistics.inferences, 0U);
    } else {
        EXPECT_GT(peak(output), silence);
        EXPECT_EQ(statistics.onsets, hardCase.onsets);
        EXPECT_GT(statistics.inferences, 0U);
    }

    expectSilenceAfterLiftOff(open, hardCase.state(updates - 1).touch_counter, output);
    EXPECT_EQ(open.statistics().underruns, 0U);
    expectNoStep(output);
}

INSTANTIATE_TEST_SUITE_P(OnModel, HardCaseTest, ::testing::Combine(subjects, ::testing::ValuesIn(hardCases())),
                         subjectAndCaseName);

// Extreme scenes and tracker data, from the contact model to the rendered sound of a voice, on each tier of the shipped
// model and on an untrained one.

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

/// Samples on the face, changed by `change`.
std::function<TipSample(int)> changed(const std::function<void(TipSample&, int)>& change) {
    return [change](int frame) {
        TipSample sample = onFace(frame);
        change(sample, frame);
        return sample;
    };
}

/// Samples of which every third is changed.
std::function<TipSample(int)> corrupted(const std::function<void(TipSample&)>& corrupt) {
    return changed([corrupt](TipSample& sample, int frame) {
        if (frame % 3 == 2) {
            corrupt(sample);
        }
    });
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
         changed([](TipSample& sample, int frame) { sample.timeSeconds += frame > 50 ? 10.0 : 0.0; })},
        {"TeleportEveryThirdUpdate", box(), corrupted([](TipSample& sample) { sample.positionMetres.x += 5.0; })},
        {"TeleportOnTheSurface", box(),
         changed([](TipSample& sample, int frame) { sample.positionMetres.x += frame % 20 < 10 ? 0.05 : -0.05; })},
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
        {"ScaleAMillion", box(1e6), changed([](TipSample& sample, int) { sample.positionMetres.y += 1e5 - 0.1; })},
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
