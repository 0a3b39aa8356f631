#include "learning/learner.hpp"
#include "learning/made_recording.hpp"
#include "learning/sliding.hpp"
#include "recordings/prepared_recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

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

TEST(RecordingCheckTest, AUsableRecordingIsAccepted) {
    const MadeRecording made({}, {});
    EXPECT_NO_THROW(prepareAndFind(made.view()));
}

TEST(RecordingCheckTest, ASecondAndAHalfIsTooShort) {
    const MadeRecording made({}, {.seconds = 1.5});
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("lasts 1.5 s; record 10 s or more of sliding")));
}

TEST(RecordingCheckTest, ASensorThatNeverChangesIsSilent) {
    MadeRecording made({}, {});
    std::ranges::fill(made.acceleration, 9.8F);
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("never changes")));
}

TEST(RecordingCheckTest, SamplesAtTheEndOfTheRangeAreClipped) {
    MadeRecording made({}, {});
    for (float& value : made.acceleration) {
        value = std::clamp(value, -2.0F, 2.0F);
    }
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("is clipped")));
}

TEST(RecordingCheckTest, ARecordingThatIsMostlyNotFiniteIsRefused) {
    MadeRecording made({}, {});
    std::fill_n(made.acceleration.begin(), made.acceleration.size() * 3 / 5, std::numeric_limits<float>::quiet_NaN());
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("is not finite in 60 %")));
}

TEST(RecordingCheckTest, APauseOfAMinuteBetweenTwoPartsIsNoDamage) {
    const MadeRecording made({}, {});
    const auto pause = static_cast<std::ptrdiff_t>(60.0 * made.view().rateHz);
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

TEST(RecordingCheckTest, ARecordingOfARestingTipIsRefused) {
    MadeRecording made({}, {});
    made.velocity.clear();
    made.constantVelocity = {0.001, 0.0};
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("the tip never moves")));
}

TEST(RecordingCheckTest, TheErrorForAnImpossibleSpeedSuggestsAUnit) {
    MadeRecording made({}, {});
    for (float& value : made.velocity) {
        value *= 1000.0F;
    }
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("is it in mm/s?")));
}

TEST(RecordingCheckTest, ASpeedBeyondTheModelIsRefused) {
    MadeRecording made({}, {});
    made.velocity.clear();
    made.constantVelocity = {2.0, 0.0};
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("the model was trained up to 1.5 m/s")));
}

TEST(RecordingCheckTest, NoForceAndAForceInMillinewtonsAreRefused) {
    MadeRecording made({}, {});
    made.force.clear();
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("give the force")));
    made.constantForce = 900.0;
    EXPECT_THAT([&] { prepareAndFind(made.view()); },
                ThrowsMessage<recordings::RecordingUnusable>(HasSubstr("millinewtons?")));
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

}  // namespace
}  // namespace haptoflow::learning
