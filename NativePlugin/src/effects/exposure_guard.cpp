#include "effects/exposure_guard.hpp"

#include "dsp/sample_rates.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace haptoflow::effects {
namespace {

constexpr double highPassHz = 6.310;
constexpr double lowPassHz = 1258.9;
constexpr double transitionHz = 15.915;
constexpr double transitionQuality = 0.64;

struct Analogue {
    double frequencyHz;
    double quality;
    /// Coefficients of (s / w)^2, s / w and 1 in the numerator.
    double squared;
    double linear;
    double constant;
};

}  // namespace

HandArmWeighting::HandArmWeighting(double sampleRateHz) noexcept : sections_{} {
    const std::array<Analogue, 3> analogues{{{highPassHz, 1.0 / std::numbers::sqrt2, 1.0, 0.0, 0.0},
                                             {lowPassHz, 1.0 / std::numbers::sqrt2, 0.0, 0.0, 1.0},
                                             {transitionHz, transitionQuality, 0.0, 1.0, 1.0}}};
    for (std::size_t i = 0; i < sections_.size(); ++i) {
        const Analogue& analogue = analogues[i];
        // s / w = (1 - z^-1) / (k (1 + z^-1)), exact at the section's own frequency.
        const double k = std::tan(std::numbers::pi * analogue.frequencyHz / sampleRateHz);
        const double scale = 1.0 / (1.0 + k / analogue.quality + k * k);
        Section& section = sections_[i];
        section.b0 = (analogue.squared + analogue.linear * k + analogue.constant * k * k) * scale;
        section.b1 = 2.0 * (analogue.constant * k * k - analogue.squared) * scale;
        section.b2 = (analogue.squared - analogue.linear * k + analogue.constant * k * k) * scale;
        section.a1 = 2.0 * (k * k - 1.0) * scale;
        section.a2 = (1.0 - k / analogue.quality + k * k) * scale;
    }
}

double HandArmWeighting::next(double mps2) noexcept {
    double value = mps2;
    for (Section& section : sections_) {
        const double out = section.b0 * value + section.first;
        section.first = section.b1 * value - section.a1 * out + section.second;
        section.second = section.b2 * value - section.a2 * out;
        value = out;
    }
    return value;
}

void HandArmWeighting::reset() noexcept {
    for (Section& section : sections_) {
        section.first = 0.0;
        section.second = 0.0;
    }
}

namespace {

constexpr double ticksPerSecond = 100.0;
constexpr double recentSeconds = 60.0;
// The weight after 10 s of play.
constexpr double minimumRecentWeight = 0.1535;
// Mean square of 1 mm/s^2 RMS; a quieter signal counts as silence.
constexpr double silentMeanSquare = 1e-6;
// No actuator shakes a hand harder. The limit keeps a single corrupt sample from dominating the dose for hours.
constexpr double maximumMps2 = 1e4;
// Maximum number of steps for a pause of any length; with it, pauses up to 40 s are resolved to hundredths of a second.
constexpr std::uint64_t maximumPauseSteps = 4096;

double decibels(double gain) noexcept {
    return 20.0 * std::log10(gain);
}

}  // namespace

ExposureGuard::ExposureGuard(double sampleRateHz, const ExposureLaw& law)
    : law_(law),
      tickSamples_(static_cast<std::size_t>(std::lround(dsp::requireOutputRate(sampleRateHz) / ticksPerSecond))),
      tickSeconds_(static_cast<double>(tickSamples_) / sampleRateHz),
      shortTermShare_(1.0 - std::exp(-tickSeconds_ / law.shortTermSeconds)),
      recentShare_(1.0 - std::exp(-tickSeconds_ / recentSeconds)),
      weighting_(sampleRateHz) {}

void ExposureGuard::setActuatorGain(double gain) noexcept {
    if (std::isfinite(gain) && gain > 0.0) {
        // The recent level predicts the coming level, which changes with the gain.
        const double change = gain / law_.actuatorGain;
        recentSquare_ *= change * change;
        law_.actuatorGain = gain;
    }
}

void ExposureGuard::process(std::span<float> samplesMps2) noexcept {
    for (float& sample : samplesMps2) {
        sample = passThrough(sample);
        if (++tickPosition_ == tickSamples_) {
            finishTick();
        }
    }
}

float ExposureGuard::passThrough(float sample) noexcept {
    const float finite = std::isfinite(sample) ? sample : 0.0F;
    const double atHand = std::clamp(static_cast<double>(finite) * law_.actuatorGain, -maximumMps2, maximumMps2);
    const double weighted = weighting_.next(atHand);
    squares_ += atHand * atHand;
    weightedSquares_ += weighted * weighted;
    if (gainFrom_ == 1.0 && gainTo_ == 1.0) {
        return finite;
    }
    const double share = static_cast<double>(tickPosition_) / static_cast<double>(tickSamples_);
    return static_cast<float>(static_cast<double>(finite) * (gainFrom_ + share * (gainTo_ - gainFrom_)));
}

void ExposureGuard::finishTick() noexcept {
    const auto count = static_cast<double>(tickSamples_);
    const double meanSquare = squares_ / count;
    measure(meanSquare, weightedSquares_ / count);
    tickPosition_ = 0;
    squares_ = 0.0;
    weightedSquares_ = 0.0;
    advanceSlots(tickSeconds_);
    moveGain(tickSeconds_, meanSquare <= silentMeanSquare);
    publish();
}

void ExposureGuard::measure(double meanSquare, double weightedMeanSquare) noexcept {
    shortTermSquare_ += shortTermShare_ * (meanSquare - shortTermSquare_);
    if (weightedMeanSquare > silentMeanSquare) {
        recentSquare_ += recentShare_ * (weightedMeanSquare - recentSquare_);
        recentWeight_ += recentShare_ * (1.0 - recentWeight_);
    } else {
        ageRecentLevel(tickSeconds_);
    }
    const double gain = 0.5 * (gainFrom_ + gainTo_);
    const double energy = gain * gain * weightedMeanSquare * tickSeconds_;
    slotEnergies_[slot_] += energy;
    energy_ += energy;
}

void ExposureGuard::ageRecentLevel(double seconds) noexcept {
    const double lowest = allowedSquare(0.0);
    const double recent = recentMeanSquare();
    if (recent > lowest) {
        recentSquare_ *= std::max(lowest / recent, std::exp(-seconds / recentSeconds));
    }
}

void ExposureGuard::advanceSlots(double seconds) noexcept {
    const double slotLength = law_.dailySeconds / static_cast<double>(slots - 1);
    slotSeconds_ += seconds;
    for (std::size_t advanced = 0; slotSeconds_ >= slotLength && advanced < slots; ++advanced) {
        slotSeconds_ -= slotLength;
        slot_ = (slot_ + 1) % slots;
        slotEnergies_[slot_] = 0.0;
        energy_ = std::accumulate(slotEnergies_.begin(), slotEnergies_.end(), 0.0);
    }
    if (slotSeconds_ >= slotLength) {
        slotSeconds_ = std::fmod(slotSeconds_, slotLength);
    }
}

double ExposureGuard::shortTermTarget() const noexcept {
    const double level = std::sqrt(shortTermSquare_);
    return level > law_.shortTermMps2 ? law_.shortTermMps2 / level : 1.0;
}

double ExposureGuard::allowedSquare(double energy) const noexcept {
    const double left = law_.dailyMps2 * law_.dailyMps2 * law_.dailySeconds - energy;
    return std::max(0.0, left) / law_.reserveSeconds;
}

double ExposureGuard::recentMeanSquare() const noexcept {
    return recentSquare_ / std::max(recentWeight_, minimumRecentWeight);
}

double ExposureGuard::doseTarget() const noexcept {
    const double allowed = allowedSquare(energy_);
    const double recent = recentMeanSquare();
    return recent > allowed ? std::sqrt(allowed / recent) : 1.0;
}

void ExposureGuard::moveGain(double seconds, bool isSilent) noexcept {
    const double shortTerm = shortTermTarget();
    const double dose = doseTarget();
    const double targetDb = decibels(std::max(law_.minimumGain, std::min(shortTerm, dose)));
    const double stepDb = law_.slewDbPerSecond * seconds;
    const double lowestDb = isSilent ? gainDb_ : gainDb_ - stepDb;
    gainDb_ = std::min(0.0, std::clamp(targetDb, lowestDb, gainDb_ + stepDb));
    gainFrom_ = gainTo_;
    gainTo_ = isOn_ ? std::pow(10.0, gainDb_ / 20.0) : 1.0;
    if (gainTo_ == 1.0) {
        reason_ = ExposureReason::none;
        loweredSeconds_ = 0.0;
        return;
    }
    loweredSeconds_ += seconds;
    if (std::min(shortTerm, dose) < 1.0) {
        reason_ = shortTerm < dose ? ExposureReason::shortTerm : ExposureReason::dose;
    }
}

void ExposureGuard::passSilence(std::uint64_t samples) noexcept {
    weighting_.reset();
    const std::uint64_t untilTick = tickSamples_ - tickPosition_;
    if (samples < untilTick) {
        tickPosition_ += static_cast<std::size_t>(samples);
        return;
    }
    finishTick();
    skipTicks((samples - untilTick) / tickSamples_);
    tickPosition_ = static_cast<std::size_t>((samples - untilTick) % tickSamples_);
}

// Long pauses take coarser steps, because in silence the gain only rises, at the limited rate.
void ExposureGuard::skipTicks(std::uint64_t ticks) noexcept {
    const std::uint64_t step = ticks / maximumPauseSteps + 1;
    while (ticks > 0) {
        const std::uint64_t now = std::min(step, ticks);
        const double seconds = static_cast<double>(now) * tickSeconds_;
        shortTermSquare_ *= std::exp(-seconds / law_.shortTermSeconds);
        ageRecentLevel(seconds);
        advanceSlots(seconds);
        moveGain(seconds, true);
        ticks -= now;
    }
    publish();
}

void ExposureGuard::continueFrom(const ExposureGuard& before) noexcept {
    shortTermSquare_ = before.shortTermSquare_;
    recentSquare_ = before.recentSquare_;
    recentWeight_ = before.recentWeight_;
    slotEnergies_ = before.slotEnergies_;
    slot_ = before.slot_;
    slotSeconds_ = before.slotSeconds_;
    energy_ = before.energy_;
    gainDb_ = before.gainDb_;
    gainFrom_ = before.gainFrom_;
    gainTo_ = before.gainTo_;
    reason_ = before.reason_;
    loweredSeconds_ = before.loweredSeconds_;
    publish();
}

void ExposureGuard::publish() noexcept {
    publishedReason_.store(reason_, std::memory_order_relaxed);
    publishedGain_.store(gainTo_, std::memory_order_relaxed);
    publishedShortTermMps2_.store(std::sqrt(shortTermSquare_), std::memory_order_relaxed);
    publishedDailyMps2_.store(std::sqrt(energy_ / law_.dailySeconds), std::memory_order_relaxed);
    publishedLoweredSeconds_.store(loweredSeconds_, std::memory_order_relaxed);
}

ExposureReport ExposureGuard::report() const noexcept {
    return {.reason = publishedReason_.load(std::memory_order_relaxed),
            .gain = publishedGain_.load(std::memory_order_relaxed),
            .shortTermMps2 = publishedShortTermMps2_.load(std::memory_order_relaxed),
            .dailyMps2 = publishedDailyMps2_.load(std::memory_order_relaxed),
            .loweredSeconds = publishedLoweredSeconds_.load(std::memory_order_relaxed)};
}

void ExposureGuard::reset() noexcept {
    weighting_.reset();
}

bool ExposureGuard::isIdle() const noexcept {
    return gainFrom_ == 1.0 && gainTo_ == 1.0;
}

}  // namespace haptoflow::effects
