// What a hand, a scene or a caller can do to a voice, on the shipped model and on an untrained one: whatever it is, the
// output is finite, inside +-1, and silent within a block and 5 ms once contact has ended.
#include "open_engine.hpp"

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
    /// Fields have to be counted as sanitised.
    bool isRuined = false;
};

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float denormal = std::numeric_limits<float>::denorm_min();

std::function<State(uint32_t)> steady(float speedMps, float forceNewtons) {
    return [=](uint32_t) { return slidingState(speedMps, forceNewtons); };
}

/// Every third state has `ruin` done to it.
std::function<State(uint32_t)> ruined(const std::function<void(State&)>& ruin) {
    return [ruin](uint32_t update) {
        State state = slidingState();
        if (update % 3 == 2) {
            ruin(state);
        }
        return state;
    };
}

std::function<State(uint32_t)> everyField(float value) {
    return ruined([value](State& state) {
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
    std::vector<HardCase> cases{
        {"VelocityZero", steady(0.0F, 1.0F)},
        {"OneMillimetreASecond", steady(0.001F, 1.0F)},
        {"OneAndAHalfMetresASecond", steady(1.5F, 1.0F)},
        {"TwentyMetresASecond", steady(20.0F, 1.0F)},
        {"ForceZero", steady(0.1F, 0.0F)},
        {"OneMillinewton", steady(0.1F, 0.001F)},
        {"FiveNewtons", steady(0.1F, 5.0F)},
        {"AKilonewton", steady(0.1F, 1000.0F)},
        {"NanInEveryField", everyField(nan), 72.0, true},
        {"InfinityInEveryField", everyField(infinity), 72.0, true},
        {"MinusInfinityInEveryField", everyField(-infinity), 72.0, true},
        {"LargestFloatInEveryField", everyField(std::numeric_limits<float>::max()), 72.0, true},
        {"DenormalsInEveryField", everyField(denormal)},
        {"NegativeForce", ruined([](State& state) { state.force_newtons = -3.0F; }), 72.0, true},
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
        {"LabelCountAboveTheLimit", ruined([](State& state) { state.label_count = 4000000000U; }), 72.0, true},
        {"NoLabelAtAll", [](uint32_t) { return blend({}); }},
        {"LabelSwitchedEveryUpdate",
         [](uint32_t update) {
             return blend({{update % 3, 1.0F}});
         }},
        {"DirectionReversedEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.3F : -0.3F); }},
        {"SpeedJumpsEveryUpdate", [](uint32_t update) { return slidingState(update % 2 == 0 ? 0.004F : 18.0F); }},
        {"ForceJumpsEveryUpdate", [](uint32_t update) { return slidingState(0.1F, update % 2 == 0 ? 0.01F : 900.0F); }},
        {"ContactToggledEveryUpdate",
         [](uint32_t update) {
             State state = slidingState();
             state.touching = update % 2;
             state.touch_counter = update / 2;
             return state;
         }},
        {"ContactToggledFourTimesABlock",
         [](uint32_t update) {
             State state = slidingState();
             state.touching = update % 2;
             state.touch_counter = update / 2;
             return state;
         },
         750.0},
        {"TouchCounterAnewEveryUpdate",
         [](uint32_t update) {
             State state = slidingState();
             state.touch_counter = update;
             return state;
         }},
    };
    for (const double hertz : {30.0, 45.0, 72.0, 90.0, 120.0, 250.0, 500.0, 1000.0}) {
        cases.push_back({"UpdateRate" + std::to_string(static_cast<int>(hertz)), steady(0.2F, 1.0F), hertz});
    }
    return cases;
}

using Parameters = std::tuple<const char*, HardCase>;

class HardCaseTest : public ::testing::TestWithParam<Parameters> {};

TEST_P(HardCaseTest, TheOutputIsFiniteBoundedAndEndsWithTheContact) {
    const auto& [modelName, hardCase] = GetParam();
    OpenEngine open(std::string(modelName) == "Shipped" ? defaultModelPath : tinyModelPath);
    const auto frames = static_cast<uint32_t>(48000.0 / hardCase.updateHz);
    const auto updates = static_cast<uint32_t>(1.2 * hardCase.updateHz);
    for (uint32_t update = 0; update < updates; ++update) {
        const std::vector<float> heard = open.update(hardCase.state(update), frames);
        ASSERT_TRUE(allFinite(heard)) << "update " << update;
        ASSERT_LE(peak(heard), 1.0F) << "update " << update;
    }
    const haptoflow_voice_statistics statistics = open.statistics();
    EXPECT_EQ(statistics.non_finite_samples, 0U) << "nothing ruined came as far as the limiter";
    EXPECT_EQ(statistics.failures, 0U);
    EXPECT_EQ(statistics.sanitised > 0, hardCase.isRuined);
    State after = liftedState(hardCase.state(updates - 1).touch_counter);
    (void)open.update(after, 256);
    EXPECT_EQ(peak(open.render(240)) < 0.001F && peak(open.render(4800)) == 0.0F, true) << "contact has ended";
    EXPECT_EQ(open.statistics().underruns, 0U);
}

INSTANTIATE_TEST_SUITE_P(OnModel, HardCaseTest,
                         ::testing::Combine(::testing::Values("Shipped", "Untrained"),
                                            ::testing::ValuesIn(hardCases())),
                         [](const auto& parameters) {
                             return std::string(std::get<0>(parameters.param)) + std::get<1>(parameters.param).name;
                         });

}  // namespace
}  // namespace haptoflow::capi::testing
