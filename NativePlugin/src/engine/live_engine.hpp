#pragma once

#include "dsp/limiter.hpp"
#include "engine/inference_round.hpp"
#include "engine/live_voice.hpp"
#include "engine/onset_levels.hpp"
#include "engine/quality_control.hpp"
#include "engine/wake_signal.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace haptoflow::engine {

struct LiveEngineSettings {
    QualitySettings quality{};
    /// Contact states a second, by which the budget and the pace of measuring go.
    double updateRateHz = 72.0;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// Key of all noise.
    std::uint64_t seed = 1;
    /// Empty for a lead that each voice learns; otherwise 0 to 50 ms.
    std::optional<double> fixedLeadMs;
    /// Without a worker the caller steps.
    bool hasWorker = true;
};

/// The model's tiers, ready to run, in its own order.
using EngineTiers = std::vector<std::unique_ptr<inference::SegmentGenerator>>;

struct TierTimes {
    std::size_t runs = 0;
    double medianMs = 0.0;
    double percentile99Ms = 0.0;
};

/// What the engine has done, for people to look at.
struct EngineStatistics {
    std::uint64_t rounds = 0;
    std::uint64_t segments = 0;
    std::uint64_t failedRounds = 0;
    /// How often the worker woke, for whatever reason.
    std::uint64_t wakes = 0;
    std::size_t voices = 0;
    std::size_t tier = 0;
    bool measuring = false;
    std::uint64_t stepsDown = 0;
    std::uint64_t stepsUp = 0;
    double budgetMs = 0.0;
    double lastRoundMs = 0.0;
    std::vector<TierTimes> tiers;
};

/// All voices of one model, and the one thread that generates for them. The thread sleeps while nothing is published.
class LiveEngine {
public:
    /// `tiers` in the model's order, cheapest first; at least one. Runs the level graph of the first for OnsetLevels.
    /// Throws std::invalid_argument for settings out of range, inference::InferenceError, std::system_error.
    LiveEngine(std::shared_ptr<const model::ModelFile> model, EngineTiers tiers, std::size_t startTier,
               const LiveEngineSettings& settings);
    LiveEngine(const LiveEngine&) = delete;
    LiveEngine& operator=(const LiveEngine&) = delete;
    /// Ends the worker after its present round. Voices fall silent within a block and 5 ms.
    ~LiveEngine();

    /// Ends the worker for good; may be called twice.
    void stop() noexcept;

    /// Waits for the present round. The voice must go before the engine.
    [[nodiscard]] std::shared_ptr<LiveVoice> addVoice(double outputRateHz);
    void removeVoice(const LiveVoice& voice) noexcept;

    /// Publishes on one of this engine's voices and wakes the worker where it has something to do. Wait-free.
    ContactAction publish(LiveVoice& voice, const ContactState& state) noexcept;

    /// One round by hand, for an engine without worker. Not while the worker runs.
    RoundResult step();

    /// True from the first `stop` on.
    [[nodiscard]] bool isStopping() const noexcept { return stopping_.load(std::memory_order_acquire); }

    void setQuality(const QualitySettings& quality);
    [[nodiscard]] EngineStatistics statistics() const;
    [[nodiscard]] const model::ModelFile& model() const noexcept { return *model_; }

private:
    void work() noexcept;
    /// False where time for a measuring run has come.
    [[nodiscard]] bool sleep();
    void measureOnce(std::size_t tier);
    [[nodiscard]] std::optional<std::size_t> tierToMeasure() const;

    std::shared_ptr<const model::ModelFile> model_;
    EngineTiers tiers_;
    LiveEngineSettings settings_;
    std::unique_ptr<OnsetLevels> levels_;

    // Held during a round: whoever adds or removes a voice waits for it.
    std::mutex voicesMutex_;
    std::vector<std::shared_ptr<LiveVoice>> voices_;
    std::vector<LiveVoice*> roundVoices_;
    InferenceRound round_;
    std::uint32_t voicesMade_ = 0;

    // Never held during a round: whoever looks at the figures waits for nobody.
    mutable std::mutex figuresMutex_;
    QualityControl quality_;
    EngineStatistics figures_;

    // Worker only.
    bool looksAgain_ = false;
    std::atomic<std::uint64_t> wakes_{0};
    std::atomic<bool> alive_{true};
    std::atomic<bool> stopping_{false};
    WakeSignal signal_;
    std::thread worker_;
};

}  // namespace haptoflow::engine
