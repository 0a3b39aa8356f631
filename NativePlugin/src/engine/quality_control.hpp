#pragma once

#include "dsp/sample_rates.hpp"

#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace haptoflow::engine {

/// Estimates the lead: the number of waveform samples between the read head and the start of a new segment. It learns
/// from the distance that the head moved between the planning of a segment and the block that took it. That distance
/// includes every delay: inference, scheduling, the callback's blocks and their bursts. Worker thread.
class LeadEstimator {
public:
    static constexpr std::int64_t minimumSamples = 2;
    /// 50 ms. A segment that takes longer is late.
    static constexpr double maximumMs = 50.0;
    static constexpr std::int64_t maximumSamples = 100;
    static_assert(maximumMs * dsp::waveformRateHz == maximumSamples * 1000.0);

    /// Waveform samples in a lead stated in milliseconds, rounded up.
    [[nodiscard]] static std::int64_t samplesOf(double milliseconds) noexcept {
        return static_cast<std::int64_t>(std::ceil(milliseconds * dsp::waveformRateHz / 1000.0));
    }

    /// Adds the lead that one segment needed, at a reading rate of 1.
    void observe(std::int64_t advancedSamples) noexcept;
    /// The 99th percentile of the last observations plus one sample, and at least `blockAdvance`, the longest block.
    [[nodiscard]] std::int64_t samples(std::int64_t blockAdvance) const noexcept;

private:
    // Of this many observations, the second largest is the 99th percentile: one stall does not lengthen the lead, two
    // do.
    static constexpr std::size_t window = 128;
    // Without observations, the lead is two blocks and 4 ms.
    static constexpr std::int64_t initialInferenceSamples = 8;

    std::array<std::int64_t, window> advances_{};
    std::size_t count_ = 0;
};

/// Times in milliseconds of a tier's last runs, per segment. One thread adds; any thread reads without
/// waiting or allocating, and sorts on its own stack.
class RunTimes {
public:
    static constexpr std::size_t window = 128;

    void add(double milliseconds) noexcept;
    [[nodiscard]] std::size_t count() const noexcept { return count_.load(std::memory_order_acquire); }
    /// `share` is in [0, 1]: 0.5 gives the median, 0.99 the 99th percentile. 0 before the first run.
    [[nodiscard]] double percentile(double share) const noexcept;

private:
    std::array<std::atomic<float>, window> milliseconds_{};
    std::atomic<std::size_t> count_{0};
};

/// Contact states a second.
inline constexpr double defaultUpdateRateHz = 72.0;
/// Share of the time between two contact states that inference may take.
inline constexpr double defaultBudgetShare = 0.25;

struct QualitySettings {
    /// Empty for automatic quality; otherwise the tier to use.
    std::optional<std::size_t> fixedTier;
    /// Time budget of one round of inference for all touching voices together.
    double budgetMs = 1000.0 * defaultBudgetShare / defaultUpdateRateHz;
};

/// Decides which tier of the model generates the next segments. Automatic quality first measures every tier. A tier
/// fits the budget if its 99th-percentile time, multiplied by the number of touching voices, does not exceed it.
/// Automatic quality takes the most accurate tier that fits, or the fastest one if none fits. When rounds overrun the
/// budget, it steps down to the next less accurate tier that is faster. It steps up again only after a long time
/// without overruns, and only if the better tier fits with room to spare. One thread at a time calls it; any thread may
/// read the times.
class QualityControl {
public:
    /// Number of runs that automatic quality measures of each tier before it decides.
    static constexpr std::size_t measuringRuns = 20;

    /// `byAccuracy` lists each tier once, the least accurate first; empty for the model's order. Throws
    /// std::invalid_argument for a tier that the model does not have or an order that does not list each tier once.
    QualityControl(std::size_t tiers, const QualitySettings& settings, std::size_t startTier,
                   std::vector<std::size_t> byAccuracy = {});

    [[nodiscard]] std::size_t tier() const noexcept { return tier_; }
    [[nodiscard]] bool isAutomatic() const noexcept { return !settings_.fixedTier.has_value(); }
    /// The next tier to measure; empty if all are measured.
    [[nodiscard]] std::optional<std::size_t> tierToMeasure() const noexcept;
    /// Records a measuring run of one segment. After the last one, automatic quality takes its first decision.
    void recordMeasurement(std::size_t tier, double milliseconds) noexcept;
    /// Records a live round of the present tier that generated `segments` segments for `voices` voices: a voice may
    /// need several in a round.
    void recordRound(double milliseconds, std::size_t voices, std::size_t segments) noexcept;
    void setSettings(const QualitySettings& settings) noexcept;

    [[nodiscard]] double budgetMs() const noexcept { return settings_.budgetMs; }
    [[nodiscard]] const RunTimes& times(std::size_t tier) const { return times_.at(tier); }
    [[nodiscard]] std::uint64_t stepsDown() const noexcept { return stepsDown_; }
    [[nodiscard]] std::uint64_t stepsUp() const noexcept { return stepsUp_; }

private:
    static constexpr std::uint32_t overrunsToStepDown = 3;
    static constexpr std::uint64_t overrunWindowRounds = 32;
    // Rounds without an overrun before a step up: 5 s at first (at 72 updates per second), doubled at each step down,
    // up to 80 s.
    static constexpr std::uint64_t initialPatienceRounds = 360;
    static constexpr std::uint64_t maximumPatienceRounds = 5760;
    static constexpr double roomToStepUp = 0.7;

    [[nodiscard]] std::size_t fittingTier() const noexcept;
    /// The next less accurate tier, without those measured to be at least as slow as the present one.
    [[nodiscard]] std::optional<std::size_t> fasterTier() const noexcept;
    /// The next more accurate tier, without those for which a still more accurate tier was measured to be at least as
    /// fast.
    [[nodiscard]] std::optional<std::size_t> betterTier() const noexcept;
    [[nodiscard]] std::size_t rankOf(std::size_t tier) const noexcept;
    [[nodiscard]] bool isMeasuredAsFastAs(std::size_t tier, std::size_t other) const noexcept;
    void note(std::size_t tier, double milliseconds) noexcept;
    void stepDown() noexcept;
    void considerStepUp(std::size_t voices) noexcept;

    QualitySettings settings_;
    std::vector<RunTimes> times_;
    // Medians of the measuring runs, which are comparable because they were made under the same load. Empty until all
    // runs of a tier are made.
    std::vector<std::optional<double>> firstMedianMs_;
    std::vector<std::size_t> byAccuracy_;
    std::size_t tier_;
    std::uint64_t roundsSinceOverrun_ = 0;
    std::uint64_t roundsInWindow_ = 0;
    std::uint32_t overruns_ = 0;
    std::uint64_t patienceRounds_ = initialPatienceRounds;
    std::uint64_t stepsDown_ = 0;
    std::uint64_t stepsUp_ = 0;
    // Maximum number of voices in a round since the last choice of a tier.
    std::size_t voices_ = 1;
};

}  // namespace haptoflow::engine
