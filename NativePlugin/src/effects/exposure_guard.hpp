#pragma once

#include "effects/effect.hpp"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace haptoflow::effects {

/// The frequency weighting W_h of hand-transmitted vibration, sample by sample.
///
/// ISO 5349-1:2001, annex A (the same in ISO 8041-1), as a product of three transfer functions in s, w = 2 pi f:
///   high-pass      s^2 / (s^2 + w1 s / Q1 + w1^2)                  f1 = 6.310 Hz, Q1 = 1 / sqrt 2
///   low-pass       w2^2 / (s^2 + w2 s / Q1 + w2^2)                 f2 = 1258.9 Hz
///   a-v transition (1 + s / w3) / (1 + s / (Q2 w3) + (s / w3)^2)   f3 = f4 = 15.915 Hz, Q2 = 0.64
/// each discretised by the bilinear transform, prewarped to be exact at its own frequency. The weighting follows
/// acceleration below about 16 Hz and velocity above: 0.958 at 12.5 Hz, 0.101 at 160 Hz, 0.0135 at 1 kHz (table A.2).
///
/// Used by one thread at a time; allocates nothing.
class HandArmWeighting {
public:
    /// `sampleRateHz` is 8 to 192 kHz.
    explicit HandArmWeighting(double sampleRateHz) noexcept;

    /// Filters the next sample.
    [[nodiscard]] double next(double mps2) noexcept;
    void reset() noexcept;

private:
    /// Transposed direct form II.
    struct Section {
        double b0 = 0.0;
        double b1 = 0.0;
        double b2 = 0.0;
        double a1 = 0.0;
        double a2 = 0.0;
        double first = 0.0;
        double second = 0.0;
    };

    std::array<Section, 3> sections_;
};

/// Why the guard reduces the level at present.
enum class ExposureReason : std::uint8_t { none, shortTerm, dose };

/// Parameters of the exposure limits, finite and above 0. Levels are RMS at the hand, m/s^2.
struct ExposureLaw {
    /// Acceleration at the hand per m/s^2 of the signal.
    double actuatorGain = 1.0;
    /// Limit of the unweighted equivalent level, and the time constant of its mean.
    double shortTermMps2 = 60.0;
    double shortTermSeconds = 300.0;
    /// Limit of the daily exposure value A(8), weighted by W_h, and its reference time.
    double dailyMps2 = 2.5;
    double dailySeconds = 8.0 * 3600.0;
    /// Minimum time for which the rest of the daily dose must last at the allowed level.
    double reserveSeconds = 600.0;
    /// Maximum rate of change of the gain, in both directions.
    double slewDbPerSecond = 1.0;
    /// Minimum gain of the guard.
    double minimumGain = 0.01;
};

/// State of a guard in the latest hundredth of a second.
struct ExposureReport {
    ExposureReason reason = ExposureReason::none;
    /// Gain on the signal; 1 while the level is not reduced.
    double gain = 1.0;
    /// Unweighted equivalent level of the last minutes as it would be without the guard, m/s^2.
    double shortTermMps2 = 0.0;
    /// A(8) of the vibration that has reached the hand, weighted by W_h, m/s^2.
    double dailyMps2 = 0.0;
    /// Time since the level has been reduced without interruption; 0 while it is not reduced.
    double loweredSeconds = 0.0;
};

/// Reduces the level after long exposure to strong vibration, slowly enough that no step is felt.
///
/// Every hundredth of a second, the guard takes the mean squares of its input times the actuator's gain: a^2 unweighted
/// and a_w^2 weighted by W_h (ISO 5349-1). It then moves its gain by at most 1 dB/s, linearly within each hundredth,
/// towards the lower of two targets:
///
/// 1. Short term. L^2 is the exponential mean of a^2 with a time constant of 300 s. The target is 60 m/s^2 / L if L is
///    above 60 m/s^2, else 1. A sinusoid at the default full scale of 200 m/s^2 reaches this limit after one minute.
/// 2. Dose. E, the integral of (gain a_w)^2 over the last 8 hours, is the dose that has reached the hand. A(8) = sqrt(E
///    / 8 h) is the daily exposure value of ISO 5349-1, and 2.5 m/s^2 is the action value of directive 2002/44/EC. The
///    remaining dose, (2.5 m/s^2)^2 8 h - E, must last for 10 minutes. The target is sqrt(remaining / 600 s) / a_r if
///    that is below 1; a_r^2 is the exponential mean of a_w^2 over a minute of play (at least ten seconds, without
///    silence). The allowed level thus falls with the remaining dose, and A(8) approaches 2.5 m/s^2 without exceeding
///    it, except for the sound while the gain moves.
///
/// No target is below 0.01 (-40 dB). The dose is stored in 97 slots of 5 minutes, so its window moves in such steps.
///
/// In silence (below 1 mm/s^2 RMS) the gain never falls, since nothing reaches the hand that lowering it would spare.
/// It rises: L decays with its 300 s, and a_r^2, where a_w is silent, with a time constant of a minute down to (2.5
/// m/s^2)^2 8 h / 600 s, the highest level that a day without exposure allows. After minutes of silence the second
/// target is therefore at least the square root of the remaining share of the dose, whatever was played before, and 1
/// once the dose has left the window. a_r does not decay further, because the next sound must not find a higher gain
/// than the rest of the dose permits.
///
/// A guard that is switched off lets the signal pass and measures on, because that signal reaches the hand, too. When
/// it is switched on again, it has the gain that the exposure of the whole day requires, within two hundredths of a
/// second.
///
/// Choice of the figures: 20 recorded pen strokes at the default level and 3 N reach 32 m/s^2 unweighted over the whole
/// set and 53 m/s^2 in the loudest stroke (sandpaper); weighted, 6.2 and 10.6 m/s^2 (carpet). Played without pause, the
/// set reaches a limit after two hours on sandpaper and concrete and after 66 minutes on carpet. The first limit is
/// meant to prevent numbness: minutes of vibration at 125-250 Hz shift the vibration threshold temporarily (Harada and
/// Griffin 1991), and W_h hardly weighs these frequencies. Its value is chosen from the strokes, not from a standard.
/// The guard is not a medical device: it measures one axis of one voice and relies on the stated gain of the actuator.
///
/// At a gain of 1 the signal passes unchanged, bit for bit. The result depends neither on the rate nor on how the
/// signal is cut into blocks. Non-finite samples become 0. Construction and `report` excepted, everything runs on the
/// audio thread: allocates nothing, waits for nothing.
class ExposureGuard final : public Effect {
public:
    /// Throws std::invalid_argument for a rate outside 8-192 kHz.
    explicit ExposureGuard(double sampleRateHz, const ExposureLaw& law = {});

    /// Sets the actuator's gain from the next sample on. The recent level is rescaled to the new gain; the dose stays.
    /// Ignores a value that is not finite and above 0. May be called before every block.
    void setActuatorGain(double gain) noexcept;
    /// Switches the guard on (as it is at first) or off.
    void switchOn(bool isOn) noexcept { isOn_ = isOn; }
    [[nodiscard]] bool isOn() const noexcept { return isOn_; }
    /// Accounts for time that passed in silence without calls of `process`.
    void passSilence(std::uint64_t samples) noexcept;
    /// Takes over the measured exposure and the gain of `before`, which ran at another rate for the same hand. Whether
    /// this guard is on does not change.
    void continueFrom(const ExposureGuard& before) noexcept;

    /// Any thread. Each value belongs to the latest hundredth of a second or to the one before.
    [[nodiscard]] ExposureReport report() const noexcept;

    void process(std::span<float> samplesMps2) noexcept override;
    /// Clears the signal state; exposure and gain stay.
    void reset() noexcept override;
    /// True while the level is not reduced. Silence that is not processed is not counted, which errs on the safe side.
    [[nodiscard]] bool isIdle() const noexcept override;

private:
    static constexpr std::size_t slots = 97;

    [[nodiscard]] float passThrough(float sample) noexcept;
    void finishTick() noexcept;
    void measure(double meanSquare, double weightedMeanSquare) noexcept;
    void ageRecentLevel(double seconds) noexcept;
    void advanceSlots(double seconds) noexcept;
    void moveGain(double seconds, bool isSilent) noexcept;
    void skipTicks(std::uint64_t ticks) noexcept;
    /// The mean square at which `energy` reaches the hand within the reserve time.
    [[nodiscard]] double allowedSquare(double energy) const noexcept;
    /// The mean over the time that has played, at least 10 s, without the silence before it.
    [[nodiscard]] double recentMeanSquare() const noexcept;
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

    bool isOn_ = true;
    /// The gain of the guard while it is on.
    double gainDb_ = 0.0;
    /// Gain at the start and at the end of the present hundredth of a second.
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
