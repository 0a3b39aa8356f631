// Extreme inputs of a hand, a scene or a caller, on each tier of the shipped model and on an untrained one. In every
// case the output is finite, within +-1 and without a step, and it is silent within a block and 5 ms after the end of
// contact.
#include "output_checks.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <tuple>

namespace haptoflow::capi::testing {
namespace {

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
        {"WeightsZero",
         [](uint32_t) {
             return blend({{0, 0.0F}, {1, 0.0F}});
         }},
        {"WeightsNegative",
         [](uint32_t) {
             return blend({{0, -1.0F}, {1, 0.5F}});
         },
         72.0, true},
        {"WeightsNotSummingToOne",
         [](uint32_t) {
             return blend({{0, 0.9F}, {1, 0.8F}, {2, 0.7F}});
         }},
        {"LabelsUnknown",
         [](uint32_t) {
             return blend({{4000000000U, 1.0F}, {77777, 1.0F}});
         }},
        {"LabelCountAboveTheLimit", corrupted([](State& state) { state.label_count = 4000000000U; }), 72.0, true},
        {"NoLabelAtAll", [](uint32_t) { return blend({}); }},
        {"LabelSwitchedEveryUpdate",
         [](uint32_t update) {
             return blend({{update % 3, 1.0F}});
         }},
        {"DirectionReversedEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.3F : -0.3F); }},
        {"SpeedJumpsEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.004F : 18.0F); }},
        {"ForceJumpsEveryUpdate", [](uint32_t update) { return slidingState(0.1F, update % 2 == 0 ? 0.01F : 900.0F); }},
        {"PlaceSurfaceAndAxesThrownAboutEveryUpdate",
         [](uint32_t update) {
             State state = slidingState(update % 2 == 0 ? 0.3F : -0.05F);
             const auto angle = static_cast<float>(update);
             state.has_place = 1;
             state.surface_seed = update % 3;
             state.place_metres[0] = 9000.0F * std::sin(7.0F * angle);
             state.place_metres[1] = std::sin(3.0F * angle);
             state.first_axis[0] = std::cos(angle);
             state.first_axis[1] = std::sin(angle);
             state.second_axis[2] = 1.0F;
             return state;
         }},
        // Lifted and touching alternate: 43 of 86 updates are touch-downs.
        {.name = "ContactToggledEveryUpdate",
         .state =
             [](uint32_t update) {
                 State state = slidingState();
                 state.touching = update % 2;
                 state.touch_counter = (update + 1) / 2;
                 return state;
             },
         .onsets = 43},
        // In one block the tip touches, lifts and touches again; in the next it lifts, taps and lifts.
        {.name = "ContactToggledFourTimesABlock",
         .state =
             [](uint32_t update) {
                 constexpr std::array<uint32_t, 8> touching{0, 1, 0, 1, 1, 0, 1, 0};
                 constexpr std::array<uint32_t, 8> touchDowns{0, 1, 1, 2, 2, 2, 3, 3};
                 State state = slidingState();
                 state.touching = touching[update % 8];
                 state.touch_counter = 3 * (update / 8) + touchDowns[update % 8];
                 return state;
             },
         .updateHz = 750.0,
         .statesOfABlock = 4,
         .onsets = 225},
        {.name = "TouchCounterAnewEveryUpdate",
         .state =
             [](uint32_t update) {
                 State state = slidingState();
                 state.touch_counter = update + 1;
                 return state;
             },
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
                EXPECT_EQ(haptoflow_engine_step(open.engine), HAPTOFLOW_OK) << message();
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

}  // namespace
}  // namespace haptoflow::capi::testing
