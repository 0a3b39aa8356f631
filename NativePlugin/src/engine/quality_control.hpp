#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace haptoflow::engine {

/// Milliseconds that a tier takes for one voice's segment, over the last runs. One thread adds; any thread reads
/// without waiting and without allocating, and sorts on its own stack.
class RunTimes {
public:
    static constexpr std::size_t window = 128;

    void add(double milliseconds) noexcept;
    [[nodiscard]] std::size_t count() const noexcept { return count_.load(std::memory_order_acquire); }
    /// 0 before the first. `share` in [0, 1]: 0.5 for the median, 0.99 for the 99th percentile.
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
    /// Empty for auto; otherwise the tier that stays.
    std::optional<std::size_t> fixedTier;
    /// What one round of inference may take, all touching voices together.
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
    /// How often each tier is run before automatic quality decides.
    static constexpr std::size_t measuringRuns = 20;

    /// `byAccuracy` names each tier once, the least accurate first; empty for their own order. Throws
    /// std::invalid_argument for a tier or an order that the model does not have.
    QualityControl(std::size_t tiers, const QualitySettings& settings, std::size_t startTier,
                   std::vector<std::size_t> byAccuracy = {});

    [[nodiscard]] std::size_t tier() const noexcept { return tier_; }
    [[nodiscard]] bool isAutomatic() const noexcept { return !settings_.fixedTier.has_value(); }
    /// The next tier that wants a measuring run; nothing when all are known.
    [[nodiscard]] std::optional<std::size_t> tierToMeasure() const noexcept;
    /// A measuring run of one voice's segment. After the last one, automatic quality takes its first decision.
    void measured(std::size_t tier, double milliseconds) noexcept;
    /// A live round for so many voices by the present tier.
    void ran(double milliseconds, std::size_t voices) noexcept;
    void setSettings(const QualitySettings& settings) noexcept;

    [[nodiscard]] double budgetMs() const noexcept { return settings_.budgetMs; }
    [[nodiscard]] const RunTimes& times(std::size_t tier) const { return times_.at(tier); }
    [[nodiscard]] std::uint64_t stepsDown() const noexcept { return stepsDown_; }
    [[nodiscard]] std::uint64_t stepsUp() const noexcept { return stepsUp_; }

private:
    static constexpr std::uint32_t overrunsToStepDown = 3;
    static constexpr std::uint64_t overrunWindowRounds = 32;
    // At 72 updates a second: 5 s at first, doubled with each step down, up to 80 s.
    static constexpr std::uint64_t firstPatienceRounds = 360;
    static constexpr std::uint64_t longestPatienceRounds = 5760;
    static constexpr double roomToStepUp = 0.7;

    [[nodiscard]] std::size_t fittingTier() const noexcept;
    /// The next less accurate tier that is not known to be as slow as the present one.
    [[nodiscard]] std::optional<std::size_t> fasterTier() const noexcept;
    /// The next more accurate tier that no still more accurate one is known to outrun.
    [[nodiscard]] std::optional<std::size_t> betterTier() const noexcept;
    [[nodiscard]] std::size_t rankOf(std::size_t tier) const noexcept;
    [[nodiscard]] bool isKnownToOutrun(std::size_t tier, std::size_t other) const noexcept;
    void note(std::size_t tier, double milliseconds) noexcept;
    void stepDown() noexcept;
    void considerStepUp(std::size_t voices) noexcept;

    QualitySettings settings_;
    std::vector<RunTimes> times_;
    // Medians of the first runs: later ones were not made under the same load. Empty until there are enough.
    std::vector<std::optional<double>> firstMedianMs_;
    std::vector<std::size_t> byAccuracy_;
    std::size_t tier_;
    std::uint64_t roundsSinceOverrun_ = 0;
    std::uint64_t roundsInWindow_ = 0;
    std::uint32_t overruns_ = 0;
    std::uint64_t patienceRounds_ = firstPatienceRounds;
    std::uint64_t stepsDown_ = 0;
    std::uint64_t stepsUp_ = 0;
    // The most that have touched at once since a tier was chosen.
    std::size_t voices_ = 1;
};

}  // namespace haptoflow::engine
