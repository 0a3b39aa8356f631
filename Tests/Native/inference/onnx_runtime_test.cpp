#include "inference/onnx_runtime.hpp"

#include "inference/load_limits.hpp"
#include "inference/solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <onnxruntime_c_api.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace haptoflow::inference {
namespace {

template <typename Action>
std::string refusalOf(Action action) {
    try {
        action();
    } catch (const RuntimeUnavailable& error) {
        return error.what();
    }
    ADD_FAILURE() << "no RuntimeUnavailable was thrown";
    return {};
}

const OrtApi* ORT_API_CALL noApi(std::uint32_t /*version*/) noexcept {
    return nullptr;
}

const char* ORT_API_CALL oldVersion() noexcept {
    return "1.2.3";
}

TEST(OnnxRuntimeTest, TheLibraryIsOpenedByPathAndItsVersionIsReported) {
    const auto runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    EXPECT_THAT(runtime->version(), ::testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+.*"));
}

TEST(OnnxRuntimeTest, TheErrorForAMissingLibraryNamesItsPath) {
    EXPECT_THAT(refusalOf([] { (void)Runtime::open("/nowhere/libonnxruntime.so"); }),
                ::testing::StartsWith("/nowhere/libonnxruntime.so: cannot be loaded"));
}

TEST(OnnxRuntimeTest, AFileThatIsNotALibraryIsRejected) {
    const std::string path = HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow";
    EXPECT_THAT(refusalOf([&] { (void)Runtime::open(path); }), ::testing::StartsWith(path));
}

TEST(OnnxRuntimeTest, ALibraryOtherThanOnnxRuntimeIsRejected) {
    EXPECT_THAT(refusalOf([] { (void)Runtime::open("libm.so.6"); }), ::testing::HasSubstr("OrtGetApiBase"));
}

TEST(OnnxRuntimeTest, AVersionWithoutTheRequiredApiIsRejected) {
    const OrtApiBase base{noApi, oldVersion};
    EXPECT_THAT(refusalOf([&] { (void)Runtime::fromApiBase(&base); }), ::testing::HasSubstr("1.2.3 is too old: 1.16"));
}

TEST(OnnxRuntimeTest, AnErrorNamesTheOperationAndTheReason) {
    const auto runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    try {
        runtime->check(runtime->api().CreateStatus(ORT_FAIL, "made by the test"), "trying");
        FAIL() << "a failure was not reported";
    } catch (const InferenceError& error) {
        EXPECT_STREQ(error.what(), "trying: made by the test");
    }
}

using Formula = std::function<void(std::span<const float>, float, std::span<float>)>;

/// A field given by a formula that records the times and intervals of its evaluations.
class FormulaField : public VelocityField {
public:
    explicit FormulaField(Formula formula) : formula_(std::move(formula)) {}

    void evaluate(std::span<const float> point, float time, float interval, std::span<float> velocity) override {
        times.push_back(time);
        intervals.push_back(interval);
        formula_(point, time, velocity);
    }

    std::vector<float> times;
    std::vector<float> intervals;

private:
    Formula formula_;
};

/// u = -x, so that x(1) = x(0) / e.
void decay(std::span<const float> point, float /*time*/, std::span<float> velocity) {
    for (std::size_t index = 0; index < point.size(); ++index) {
        velocity[index] = -point[index];
    }
}

float integrateOne(Formula formula, SolverSettings settings, float start) {
    FormulaField field(std::move(formula));
    Solver solver;
    std::array<float, 1> point{start};
    solver.integrate(field, settings, point);
    return point[0];
}

double decayError(SolverKind kind, int steps) {
    return std::fabs(static_cast<double>(integrateOne(decay, {kind, steps}, 1.0F)) - std::exp(-1.0));
}

/// The order of convergence: the binary logarithm of the error's reduction when the step is halved.
double convergenceOrder(SolverKind kind) {
    return std::log2(decayError(kind, 8) / decayError(kind, 16));
}

TEST(SolverTest, EulerConvergesWithTheFirstPowerOfTheStep) {
    EXPECT_NEAR(convergenceOrder(SolverKind::euler), 1.0, 0.1);
}

TEST(SolverTest, MidpointConvergesWithTheSecondPowerOfTheStep) {
    EXPECT_NEAR(convergenceOrder(SolverKind::midpoint), 2.0, 0.1);
}

TEST(SolverTest, HeunConvergesWithTheSecondPowerOfTheStep) {
    EXPECT_NEAR(convergenceOrder(SolverKind::heun), 2.0, 0.1);
}

TEST(SolverTest, OneStepOfDecayMatchesTheFormulas) {
    EXPECT_FLOAT_EQ(integrateOne(decay, {SolverKind::euler, 1}, 2.0F), 0.0F);
    EXPECT_FLOAT_EQ(integrateOne(decay, {SolverKind::midpoint, 1}, 2.0F), 1.0F);
    EXPECT_FLOAT_EQ(integrateOne(decay, {SolverKind::heun, 1}, 2.0F), 1.0F);
}

TEST(SolverTest, EverySolverUsesTheExpectedNumberOfEvaluations) {
    for (const SolverKind kind : {SolverKind::euler, SolverKind::midpoint, SolverKind::heun}) {
        FormulaField field(decay);
        std::array<float, 1> point{1.0F};
        Solver().integrate(field, {kind, 5}, point);
        EXPECT_EQ(field.times.size(), kind == SolverKind::euler ? 5U : 10U);
    }
}

TEST(SolverTest, ASolverAcceptsPointsOfDifferentSizes) {
    Solver solver;
    FormulaField field(decay);
    for (const std::size_t size : {1U, 600U, 200U}) {
        std::vector<float> point(size, 1.0F);
        solver.integrate(field, {SolverKind::midpoint, 1}, point);
        EXPECT_THAT(point, ::testing::Each(0.5F));
    }
}

TEST(SolverTest, StepsOutsideOneToSixteenAreRejected) {
    FormulaField field(decay);
    std::array<float, 1> point{1.0F};
    for (const int steps : {-1, 0, 17}) {
        EXPECT_THROW(Solver().integrate(field, {SolverKind::euler, steps}, point), std::invalid_argument);
    }
    EXPECT_TRUE(field.times.empty());
}

}  // namespace
}  // namespace haptoflow::inference
