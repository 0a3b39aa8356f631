#include "learning/learner.hpp"
#include "learning/made_recording.hpp"
#include "learning/sliding.hpp"
#include "recordings/dft321.hpp"
#include "recordings/prepared_recording.hpp"
#include "support/wave_measures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace haptoflow::learning {
namespace {

using ::testing::HasSubstr;
using testing::MadeRecording;
using ::testing::ThrowsMessage;

model::ModelHeader header() {
    model::ModelHeader result;
    result.speedMps.maximum = 1.5;
    result.forceNewtons.maximum = 5.0;
    return result;
}

void prepareAndFind(const recordings::Recording& recording) {
    recordings::checkRecording(recording);
    (void)findSliding(recordings::prepareRecording(recording), header());
}

struct Unusable {
    const char* what;
    std::function<void(MadeRecording&)> spoil;
    const char* said;
};

TEST(RecordingCheckTest, AUsableRecordingIsAcceptedAndEachDefectIsNamedWithItsRemedy) {
    const auto constant = [](double speed) {
        return [speed](MadeRecording& made) {
            made.velocity.clear();
            made.constantVelocity = {speed, 0.0};
        };
    };
    const auto constantForce = [](double force) {
        return [force](MadeRecording& made) {
            made.force.clear();
            made.constantForce = force;
        };
    };
    const std::vector<Unusable> cases{
        {"a second and a half", [](MadeRecording& made) { made = MadeRecording({}, {.seconds = 1.5}); },
         "lasts 1.5 s; record 10 s or more of sliding"},
        {"a sensor that never changes", [](MadeRecording& made) { std::ranges::fill(made.acceleration, 9.8F); },
         "never changes"},
        {"clipped",
         [](MadeRecording& made) {
             std::ranges::transform(made.acceleration, made.acceleration.begin(),
                                    [](float value) { return std::clamp(value, -2.0F, 2.0F); });
         },
         "is clipped"},
        {"mostly not finite",
         [](MadeRecording& made) {
             std::fill_n(made.acceleration.begin(), made.acceleration.size() * 3 / 5,
                         std::numeric_limits<float>::quiet_NaN());
         },
         "is not finite in 60 %"},
        {"at rest", constant(0.001), "the tip never moves"},
        {"mm/s",
         [](MadeRecording& made) {
             std::ranges::transform(made.velocity, made.velocity.begin(), [](float value) { return 1000.0F * value; });
         },
         "is it in mm/s?"},
        {"a speed beyond the model", constant(2.0), "the model was trained up to 1.5 m/s"},
        {"no force", constantForce(0.0), "give the force"},
        {"millinewtons", constantForce(900.0), "millinewtons?"},
    };
    const MadeRecording usable({}, {});
    EXPECT_NO_THROW(prepareAndFind(usable.view()));
    for (const Unusable& each : cases) {
        MadeRecording made = usable;
        each.spoil(made);
        EXPECT_THAT([&] { prepareAndFind(made.view()); },
                    ThrowsMessage<recordings::RecordingUnusable>(HasSubstr(each.said)))
            << each.what;
    }
}

TEST(RecordingCheckTest, APauseOfAMinuteBetweenTwoPartsIsNoDamage) {
    const MadeRecording made({}, {});
    const auto pause = static_cast<std::size_t>(60.0 * made.view().rateHz);
    const auto middle = static_cast<std::ptrdiff_t>(made.acceleration.size() / 2);
    MadeRecording paused = made;
    constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
    paused.acceleration.insert(paused.acceleration.begin() + middle, pause, unknown);
    paused.velocity.insert(paused.velocity.begin() + 2 * middle, 2 * pause, unknown);
    paused.force.insert(paused.force.begin() + middle, pause, unknown);
    EXPECT_NO_THROW(prepareAndFind(paused.view()));
    const Sliding whole = findSliding(recordings::prepareRecording(made.view()), header());
    const Sliding parts = findSliding(recordings::prepareRecording(paused.view()), header());
    EXPECT_NEAR(parts.seconds, whole.seconds, 0.3);
    // Between the parts of damage there is no pause.
    for (std::size_t i = 0; i < paused.acceleration.size(); ++i) {
        paused.acceleration[i] = i % 5 < 3 ? unknown : paused.acceleration[i];
    }
    EXPECT_THAT([&] { prepareAndFind(paused.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("is not finite in 60")));
}

TEST(RecordingCheckTest, SizesAndRatesThatDoNotFitAreInvalidArguments) {
    const MadeRecording made({}, {});
    recordings::Recording recording = made.view();
    recording.axisCount = 2;
    EXPECT_THROW(recordings::checkRecording(recording), std::invalid_argument);
    recording = made.view();
    recording.rateHz = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(recordings::checkRecording(recording), std::invalid_argument);
    recording = made.view();
    recording.velocityMps = recording.velocityMps.first(10);
    EXPECT_THROW(recordings::checkRecording(recording), std::invalid_argument);
    recording = made.view();
    recording.forceNewtons = recording.forceNewtons.first(10);
    EXPECT_THROW(recordings::checkRecording(recording), std::invalid_argument);
}

std::vector<float> tone(double hertz, double rateHz, double seconds) {
    return haptoflow::testing::sine(hertz, 1.0, seconds, rateHz);
}

double rmsInside(std::span<const float> wave) {
    constexpr std::size_t margin = 400;
    return haptoflow::testing::rms(wave.subspan(margin, wave.size() - 2 * margin));
}

recordings::PreparedRecording prepared(const std::vector<float>& wave, double rateHz) {
    return recordings::prepareRecording({.rateHz = rateHz,
                                         .axisCount = 1,
                                         .accelerationMps2 = wave,
                                         .constantVelocityMps = {0.1, 0.0},
                                         .constantForceNewtons = 1.0});
}

TEST(PreparationTest, ASineInsideTheBandKeepsItsLevelAndTimeAtAnyRate) {
    for (const double rateHz : {1000.0, 1666.0, 2000.0, 6024.1, 44'100.0, 192'000.0}) {
        const recordings::PreparedRecording recording = prepared(tone(150.0, rateHz, 4.0), rateHz);
        EXPECT_NEAR(rmsInside(recording.wave), std::numbers::sqrt2 / 2.0, 0.005) << rateHz;
        const std::vector<float> wanted = tone(150.0, 2000.0, 4.0);
        for (std::size_t i = 2000; i < 2040; ++i) {
            EXPECT_NEAR(recording.wave[i], wanted[i], 0.02) << rateHz;
        }
    }
}

TEST(PreparationTest, FrequenciesAbove1KilohertzAreRemovedAndNotAliased) {
    EXPECT_LT(rmsInside(prepared(tone(1500.0, 8000.0, 4.0), 8000.0).wave), 0.001);
    EXPECT_LT(rmsInside(prepared(tone(3.0, 8000.0, 4.0), 8000.0).wave), 0.001);
}

TEST(PreparationTest, OneMovingAxisOfThreeIsReturnedUnchanged) {
    const std::vector<float> wave = tone(120.0, 2000.0, 2.0);
    std::array<std::vector<double>, 3> axes;
    axes[0].assign(wave.size(), 0.0);
    axes[1].assign(wave.begin(), wave.end());
    axes[2].assign(wave.size(), 0.0);
    const std::vector<double> combined = recordings::combineAxes(axes);
    for (std::size_t i = 500; i < 3500; ++i) {
        ASSERT_NEAR(combined[i], axes[1][i], 0.02);
    }
}

TEST(PreparationTest, ThreeAxesKeepTheirEnergyEvenWhereTheyCancel) {
    std::array<std::vector<double>, 3> axes;
    std::vector<float> noise(8000);
    double energy = 0.0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
        skeleton::fillStandardNormal({.seed = 3, .voice = static_cast<std::uint32_t>(axis), .segment = 0}, noise);
        axes[axis] = recordings::bandPassed(std::vector<double>(noise.begin(), noise.end()));
        for (const double value : axes[axis]) {
            energy += value * value;
        }
    }
    axes[2] = axes[0];
    std::ranges::transform(axes[2], axes[2].begin(), [](double value) { return -0.8 * value; });
    for (const double value : axes[2]) {
        energy += value * value;
    }
    double found = 0.0;
    for (const double value : recordings::combineAxes(axes)) {
        found += value * value;
    }
    EXPECT_NEAR(10.0 * std::log10(found / energy), 0.0, 0.5);
}

TEST(PreparationTest, AMissingSampleExcludesOnlyTheSamplesAroundIt) {
    MadeRecording made({}, {});
    const recordings::PreparedRecording whole = recordings::prepareRecording(made.view());
    EXPECT_EQ(std::ranges::count(whole.isUsable, 0), 0);
    for (std::size_t i = 20'000; i < 20'028; ++i) {
        made.acceleration[i] = std::numeric_limits<float>::quiet_NaN();
    }
    made.force[30'000] = std::numeric_limits<float>::infinity();
    const recordings::PreparedRecording holed = recordings::prepareRecording(made.view());
    const auto lost = std::ranges::count(holed.isUsable, 0);
    EXPECT_GT(lost, 400);
    EXPECT_LT(lost, 600);
    for (std::size_t i = 0; i < whole.wave.size(); ++i) {
        ASSERT_TRUE(std::isfinite(holed.wave[i]));
        ASSERT_TRUE(std::isfinite(holed.motion[i][2]));
        if (holed.isUsable[i] != 0) {
            ASSERT_NEAR(holed.wave[i], whole.wave[i], 0.05);
        }
    }
}

TEST(PreparationTest, AFrozenSensorIsExcluded) {
    MadeRecording made({}, {});
    std::fill_n(made.acceleration.begin() + 12'000, 800, made.acceleration[12'000]);
    const recordings::PreparedRecording recording = recordings::prepareRecording(made.view());
    EXPECT_EQ(recording.isUsable[6200], 0);
    EXPECT_EQ(recording.isUsable[7000], 1);
}

TEST(PreparationTest, TheSensorsNoiseIsFoundAtRestAndRemovedFromOneAxisAndFromThree) {
    for (const std::size_t axes : {1U, 3U}) {
        const recordings::PreparedRecording recording =
            recordings::prepareRecording(testing::noisy(MadeRecording({}, {}), axes).view());
        EXPECT_EQ(recording.noise.source, recordings::NoiseSource::rest);
        // Half of the power of 4 kHz lies above 1 kHz, the low-pass filter takes 0.6 dB of the rest, and frames of
        // three axes that cancel take some.
        const double found = recording.noise.rmsMps2 / (0.04 * std::sqrt(0.5 * static_cast<double>(axes)));
        EXPECT_GT(found, axes == 1 ? 0.91 : 0.86);
        EXPECT_LT(found, 0.95);
        EXPECT_LT(rmsInside(std::span(recording.wave).first(1800)), 0.012 * std::sqrt(static_cast<double>(axes)));
    }
}

TEST(PreparationTest, AConstantVelocityShowsNoRestSoThatNothingIsRemoved) {
    MadeRecording made = testing::noisy(MadeRecording({}, {}));
    made.velocity.clear();
    EXPECT_EQ(recordings::prepareRecording(made.view()).noise.source, recordings::NoiseSource::none);
}

}  // namespace
}  // namespace haptoflow::learning
