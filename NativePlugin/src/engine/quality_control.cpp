#include "engine/quality_control.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace haptoflow::engine {

void LeadEstimator::observe(std::int64_t advancedSamples) noexcept {
    advances_[count_ % window] = advancedSamples;
    ++count_;
}

std::int64_t LeadEstimator::samples(std::int64_t blockAdvance) const noexcept {
    const std::size_t known = std::min(count_, window);
    std::int64_t needed = 2 * blockAdvance + initialInferenceSamples;
    if (known >= 8) {
        std::int64_t highest = 0;
        std::int64_t second = 0;
        for (std::size_t i = 0; i < known; ++i) {
            if (advances_[i] >= highest) {
                second = highest;
                highest = advances_[i];
            } else {
                second = std::max(second, advances_[i]);
            }
        }
        needed = std::max((known == window ? second : highest) + 1, blockAdvance);
    }
    return std::clamp(needed, minimumSamples, maximumSamples);
}

namespace {

std::vector<std::size_t> modelOrder(std::size_t tiers) {
    std::vector<std::size_t> order(tiers);
    std::iota(order.begin(), order.end(), std::size_t{0});
    return order;
}

}  // namespace

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

QualityControl::QualityControl(std::size_t tiers, const QualitySettings& settings, std::size_t startTier,
                               std::vector<std::size_t> byAccuracy)
    : settings_(settings),
      times_(tiers),
      firstMedianMs_(tiers),
      byAccuracy_(byAccuracy.empty() ? modelOrder(tiers) : std::move(byAccuracy)),
      tier_(settings.fixedTier.value_or(startTier)) {
    if (tier_ >= tiers) {
        throw std::invalid_argument("quality control: tier " + std::to_string(tier_) + "; expected 0 to " +
                                    std::to_string(tiers - 1));
    }
    if (!std::ranges::is_permutation(byAccuracy_, modelOrder(tiers))) {
        throw std::invalid_argument("quality control: the order of accuracy must name each of the " +
                                    std::to_string(tiers) + " tiers once");
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

void QualityControl::recordMeasurement(std::size_t tier, double milliseconds) noexcept {
    if (tier >= times_.size()) {
        return;
    }
    note(tier, milliseconds);
    if (isAutomatic() && !tierToMeasure()) {
        tier_ = fittingTier();
    }
}

std::size_t QualityControl::fittingTier() const noexcept {
    for (auto tier = byAccuracy_.rbegin(); tier != byAccuracy_.rend(); ++tier) {
        if (times_[*tier].percentile(0.99) * static_cast<double>(voices_) <= settings_.budgetMs) {
            return *tier;
        }
    }
    return *std::ranges::min_element(byAccuracy_, {}, [this](std::size_t tier) { return firstMedianMs_[tier]; });
}

std::size_t QualityControl::rankOf(std::size_t tier) const noexcept {
    return static_cast<std::size_t>(std::ranges::find(byAccuracy_, tier) - byAccuracy_.begin());
}

bool QualityControl::isMeasuredAsFastAs(std::size_t tier, std::size_t other) const noexcept {
    return firstMedianMs_[tier] && firstMedianMs_[other] && *firstMedianMs_[tier] <= *firstMedianMs_[other];
}

void QualityControl::note(std::size_t tier, double milliseconds) noexcept {
    times_[tier].add(milliseconds);
    if (times_[tier].count() == measuringRuns) {
        firstMedianMs_[tier] = times_[tier].percentile(0.5);
    }
}

std::optional<std::size_t> QualityControl::fasterTier() const noexcept {
    for (std::size_t rank = rankOf(tier_); rank > 0; --rank) {
        const std::size_t tier = byAccuracy_[rank - 1];
        if (!isMeasuredAsFastAs(tier_, tier)) {
            return tier;
        }
    }
    return std::nullopt;
}

std::optional<std::size_t> QualityControl::betterTier() const noexcept {
    for (std::size_t rank = rankOf(tier_) + 1; rank < byAccuracy_.size(); ++rank) {
        const std::size_t tier = byAccuracy_[rank];
        const auto outruns = [&](std::size_t other) { return isMeasuredAsFastAs(other, tier); };
        const auto better = byAccuracy_.begin() + static_cast<std::ptrdiff_t>(rank) + 1;
        if (std::none_of(better, byAccuracy_.end(), outruns)) {
            return tier;
        }
    }
    return std::nullopt;
}

void QualityControl::recordRound(double milliseconds, std::size_t voices, std::size_t segments) noexcept {
    if (voices == 0 || segments == 0) {
        return;
    }
    note(tier_, milliseconds / static_cast<double>(segments));
    if (!isAutomatic()) {
        return;
    }
    if (voices > voices_) {
        // Step down before the additional voice causes overruns.
        voices_ = voices;
        const std::size_t before = tier_;
        while (!tierToMeasure() && rankOf(tier_) > rankOf(fittingTier()) && fasterTier()) {
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
    const auto faster = fasterTier();
    if (!faster) {
        return;
    }
    tier_ = *faster;
    ++stepsDown_;
    patienceRounds_ = std::min(2 * patienceRounds_, maximumPatienceRounds);
}

void QualityControl::considerStepUp(std::size_t voices) noexcept {
    if (roundsSinceOverrun_ < patienceRounds_) {
        return;
    }
    const auto better = betterTier();
    if (better && times_[*better].percentile(0.5) * static_cast<double>(voices) <= roomToStepUp * settings_.budgetMs) {
        tier_ = *better;
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
