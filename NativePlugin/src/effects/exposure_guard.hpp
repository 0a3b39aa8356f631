#pragma once

#include "effects/effect.hpp"
#include "effects/hand_arm_weighting.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptoflow::effects {

/// Why a guard lowers the level at present.
enum class ExposureReason : std::uint8_t { none, shortTerm, dose };

/// By what law an exposure guard lowers the level. Levels are root mean squares at the hand, m/s^2.
struct ExposureLaw {
    /// Acceleration at the hand for each m/s^2 of the signal.
    double actuatorGain = 1.0;
    /// Unweighted; the equivalent level of minutes that is brought down to this.
    double shortTermMps2 = 60.0;
    double shortTermSeconds = 300.0;
    /// Weighted by W_h; the daily exposure value A(8) that is not exceeded, and its reference time.
    double dailyMps2 = 2.5;
    double dailySeconds = 8.0 * 3600.0;
    /// What is left of the day's dose must last for this long at any moment.
    double reserveSeconds = 600.0;
    /// How fast the gain moves, down and up.
    double slewDbPerSecond = 1.0;
    /// Nothing is lowered further than this.
    double lowestGain = 0.01;

    /// False for a value that is not finite or not above 0, and for a lowest gain above 1.
    [[nodiscard]] bool isValid() const noexcept;
};

/// What a guard has measured and does; of the latest hundredth of a second.
struct ExposureReport {
    ExposureReason reason = ExposureReason::none;
    /// What the signal is multiplied by; 1 while nothing is lowered.
    double gain = 1.0;
    /// Equivalent level of the last minutes as it would be without the guard, unweighted, m/s^2.
    double shortTermMps2 = 0.0;
    /// A(8) of what has reached the hand, weighted by W_h, m/s^2.
    double dailyMps2 = 0.0;
    /// For how long the level has been lowered without a break; 0 while it is not.
    double loweredSeconds = 0.0;
};

/// Brings long time at a high level down, slowly enough that no step is felt.
///
/// Every hundredth of a second it takes the mean squares of its input times the actuator's gain, a^2 unweighted and
/// a_w^2 weighted by W_h (ISO 5349-1), and moves its gain by at most 1 dB a second, in a straight line within each
/// hundredth, towards the lower one of two targets:
///
/// 1. Short term. L^2 is the exponential mean of a^2 with a time constant of 300 s. Target: 60 m/s^2 / L where L is
///    above 60 m/s^2, else 1. A sinusoid at the default full scale of 200 m/s^2 gets there after one minute of play.
/// 2. Dose. E is what has reached the hand in the last 8 hours, the sum of (gain a_w)^2 over time; A(8) = sqrt(E / 8 h)
///    is the daily exposure value of ISO 5349-1, and 2.5 m/s^2 the action value of directive 2002/44/EC. What is left,
///    (2.5 m/s^2)^2 8 h - E, must last for 10 minutes: target = sqrt(left / 600 s) / a_r where that is below 1, with
///    a_r^2 the exponential mean of a_w^2 over a minute of play (ten seconds at least, silence left out). So the level
///    that is allowed falls with what is left, and A(8) approaches 2.5 m/s^2 instead of passing it (by less than what
///    sounds while the gain moves).
///
/// Neither target is below 0.01 (-40 dB). The dose is kept in 97 slots of 5 minutes, so it slides in such steps.
///
/// Why these figures: 20 recorded pen strokes at the default level, pressed with 3 N, reach 32 m/s^2 unweighted over
/// the whole set and 53 m/s^2 in the loudest stroke (sandpaper), weighted 6.2 and 10.6 m/s^2 (carpet). The set may be
/// played over and over without a pause for two hours on sandpaper and concrete, and for 66 minutes on carpet, before
/// anything is lowered. Numbness is what the first law is about: temporary shifts of the vibration threshold follow
/// minutes of vibration at 125-250 Hz (Harada and Griffin 1991), which W_h hardly counts. But its limit is chosen from
/// those strokes, not from a standard. The second law is no medical device either: it counts one axis of one voice, and
/// trusts the actuator's gain.
///
/// A gain of 1 passes the signal bit for bit. The law does not depend on the rate, nor on how the signal is cut into
/// blocks. Samples that are not finite become 0. Audio thread but for construction and `report`; allocates nothing,
/// waits for nothing.
class ExposureGuard final : public Effect {
public:
    /// Throws std::invalid_argument unless `sampleRateHz` is 8000 to 192000 and the law is valid.
    explicit ExposureGuard(double sampleRateHz, const ExposureLaw& law = {});

    /// From the next sample on; what has played lately counts as if with the new one, the dose stays. One that is not
    /// finite or not above 0 is ignored. May be called before every block.
    void setActuatorGain(double gain) noexcept;
    /// Counts time that passed in silence without `process`.
    void passSilence(std::uint64_t samples) noexcept;
    /// The same hand at another rate: takes over what `before` has measured, and its gain.
    void continueFrom(const ExposureGuard& before) noexcept;


    /// Any thread. Each value is of the latest hundredth of a second, or of the one before.
    [[nodiscard]] ExposureReport report() const noexcept;

    [[nodiscard]] EffectDeclaration declaration() const noexcept override;
    void process(std::span<float> samplesMps2) noexcept override;
    /// Forgets the signal, not what the hand has received: exposure and gain stay.
    void reset() noexcept override;
    /// True while nothing is lowered. Silence that is not run is not counted, which errs on the safe side.
    [[nodiscard]] bool isIdle() const noexcept override;

private:
    static constexpr std::size_t slots = 97;

    [[nodiscard]] float passThrough(float sample) noexcept;
    void finishTick() noexcept;
    void measure(double meanSquare, double weightedMeanSquare) noexcept;
    void advanceSlots(double seconds) noexcept;
    void moveGain(double seconds) noexcept;
    void passTicks(std::uint64_t ticks) noexcept;
    [[nodiscard]] double shortTermTarget() const noexcept;
    [[nodiscard]] double doseTarget() const noexcept;
    void publish() noexcept;

    ExposureLaw law_;
    std::size_t tickSamples_;
    double tickSeconds_;
    double shortTermShare_;
    double recentShare_;
    HandArmWeighting weighting_;

    std::size_t tickPosition_ = 0;
    double squares_ = 0.0;
    double weightedSquares_ = 0.0;

    double shortTermSquare_ = 0.0;
    double recentSquare_ = 0.0;
    double recentWeight_ = 0.0;
    std::array<double, slots> slotEnergies_{};
    std::size_t slot_ = 0;
    double slotSeconds_ = 0.0;
    double energy_ = 0.0;

    double gainDb_ = 0.0;
    /// The gain's straight line within the present hundredth of a second.
    double gainFrom_ = 1.0;
    double gainTo_ = 1.0;
    ExposureReason reason_ = ExposureReason::none;
    double loweredSeconds_ = 0.0;

    std::atomic<ExposureReason> publishedReason_{ExposureReason::none};
    std::atomic<double> publishedGain_{1.0};
    std::atomic<double> publishedShortTermMps2_{0.0};
    std::atomic<double> publishedDailyMps2_{0.0};
    std::atomic<double> publishedLoweredSeconds_{0.0};
};

}  // namespace haptoflow::effects
