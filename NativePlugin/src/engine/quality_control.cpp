#include "engine/quality_control.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace haptoflow::engine {

void RunTimes::add(double milliseconds) noexcept {
    const std::size_t before = count_.load(std::memory_order_relaxed);
    milliseconds_[before % window].store(static_cast<float>(milliseconds), std::memory_order_relaxed);
    count_.store(before + 1, std::memory_order_release);
}

double RunTimes::percentile(double share) const noexcept {
    const std::size_t known = std::min(count(), window);
    if (known == 0) {
        return 0.0;
    }
    std::array<float, window> sorted{};
    std::ranges::transform(milliseconds_, sorted.begin(),
                           [](const std::atomic<float>& each) { return each.load(std::memory_order_relaxed); });
    const auto rank = static_cast<std::size_t>(
        std::clamp(std::ceil(share * static_cast<double>(known)) - 1.0, 0.0, static_cast<double>(known - 1)));
    const auto place = sorted.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(sorted.begin(), place, sorted.begin() + static_cast<std::ptrdiff_t>(known));
    return static_cast<double>(*place);
}

QualityControl::QualityControl(std::size_t tiers, const QualitySettings& settings, std::size_t startTier)
    : settings_(settings), times_(tiers), tier_(settings.fixedTier.value_or(startTier)) {
    if (tier_ >= tiers) {
        throw std::invalid_argument("quality control: tier " + std::to_string(tier_) + " of " + std::to_string(tiers));
    }
}

std::optional<std::size_t> QualityControl::tierToMeasure() const noexcept {
    if (!isAutomatic()) {
        return std::nullopt;
    }
    for (std::size_t tier = 0; tier < times_.size(); ++tier) {
        if (times_[tier].count() < measuringRuns) {
            return tier;
        }
    }
    return std::nullopt;
}

void QualityControl::measured(std::size_t tier, double milliseconds) noexcept {
    if (tier >= times_.size()) {
        return;
    }
    times_[tier].add(milliseconds);
    if (isAutomatic() && !tierToMeasure()) {
        tier_ = fittingTier();
    }
}

std::size_t QualityControl::fittingTier() const noexcept {
    std::size_t fitting = 0;
    for (std::size_t tier = 0; tier < times_.size(); ++tier) {
        if (times_[tier].percentile(0.99) * static_cast<double>(voices_) <= settings_.budgetMs) {
            fitting = tier;
        }
    }
    return fitting;
}

void QualityControl::ran(double milliseconds, std::size_t voices) noexcept {
    if (voices == 0) {
        return;
    }
    times_[tier_].add(milliseconds / static_cast<double>(voices));
    if (!isAutomatic()) {
        return;
    }
    if (voices > voices_) {
        // Rather before the overruns than after them.
        voices_ = voices;
        const std::size_t before = tier_;
        while (!tierToMeasure() && tier_ > fittingTier()) {
            stepDown();
        }
        if (tier_ != before) {
            return;
        }
    }
    if (++roundsInWindow_ > overrunWindowRounds) {
        roundsInWindow_ = 1;
        overruns_ = 0;
    }
    ++roundsSinceOverrun_;
    if (milliseconds > settings_.budgetMs) {
        roundsSinceOverrun_ = 0;
        if (++overruns_ >= overrunsToStepDown) {
            stepDown();
        }
        return;
    }
    considerStepUp(voices);
}

void QualityControl::stepDown() noexcept {
    overruns_ = 0;
    roundsInWindow_ = 0;
    if (tier_ == 0) {
        return;
    }
    --tier_;
    ++stepsDown_;
    patienceRounds_ = std::min(2 * patienceRounds_, longestPatienceRounds);
}

void QualityControl::considerStepUp(std::size_t voices) noexcept {
    if (tier_ + 1 >= times_.size() || roundsSinceOverrun_ < patienceRounds_) {
        return;
    }
    const double expectedMs = times_[tier_ + 1].percentile(0.5) * static_cast<double>(voices);
    if (expectedMs <= roomToStepUp * settings_.budgetMs) {
        ++tier_;
        ++stepsUp_;
        roundsSinceOverrun_ = 0;
        overruns_ = 0;
        roundsInWindow_ = 0;
        voices_ = voices;
    }
}

void QualityControl::setSettings(const QualitySettings& settings) noexcept {
    settings_ = settings;
    if (settings_.fixedTier && *settings_.fixedTier < times_.size()) {
        tier_ = *settings_.fixedTier;
        return;
    }
    settings_.fixedTier.reset();
    if (!tierToMeasure()) {
        tier_ = fittingTier();
    }
}

}  // namespace haptoflow::engine
