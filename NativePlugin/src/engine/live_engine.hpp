#pragma once

#include "dsp/limiter.hpp"
#include "engine/inference_round.hpp"
#include "engine/live_voice.hpp"
#include "engine/mailbox.hpp"
#include "engine/material_library.hpp"
#include "engine/quality_control.hpp"
#include "engine/worker_thread.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace haptoflow::engine {

struct LiveEngineSettings {
    QualitySettings quality{};
    /// Places of the tiers, the least accurate first; empty for their own order.
    std::vector<std::size_t> tiersByAccuracy{};
    /// Contact states a second, by which the budget and the pace of measuring go.
    double updateRateHz = defaultUpdateRateHz;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// Key of all noise.
    std::uint64_t seed = 1;
    /// Empty for a lead that each voice learns; otherwise 0 to 50 ms.
    std::optional<double> fixedLeadMs;
    /// Without a worker the caller steps.
    bool hasWorker = true;
};

/// The model's tiers, ready to run, in its own order; null where one was not loaded.
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
    bool workerAlive = true;
    /// The system did not let the worker run at a raised priority.
    bool priorityRefused = false;
};

/// All voices of one model, and the one thread that generates for them. The thread sleeps while nothing is published.
/// The worker holds no lock while the network runs: adding, removing and reading never wait for inference.
class LiveEngine {
public:
    /// `tiers` in the model's order; at least one. Those that `settings` want must be loaded: all for
    /// automatic quality, else the one. Runs the level graph of the first loaded for MaterialLibrary. Throws
    /// std::invalid_argument for settings out of range or a tier that is not loaded, inference::InferenceError,
    /// inference::LoadCancelled, std::system_error.
    LiveEngine(std::shared_ptr<const model::ModelFile> model, EngineTiers tiers, std::size_t startTier,
               const LiveEngineSettings& settings, const inference::LoadLimits& limits = {});
    LiveEngine(const LiveEngine&) = delete;
    LiveEngine& operator=(const LiveEngine&) = delete;
    /// Ends the worker after its present round. Voices fall silent within a block and 5 ms.
    ~LiveEngine();

    /// Ends the worker for good; may be called twice.
    void stop() noexcept;

    /// Takes part from the next round on. The voice must go before the engine.
    [[nodiscard]] std::shared_ptr<LiveVoice> addVoice(double outputRateHz);
    /// Takes part in no round after the present one, which keeps the voice alive until it ends.
    void removeVoice(const LiveVoice& voice) noexcept;

    /// Publishes on one of this engine's voices and wakes the worker where it has something to do. Wait-free.
    ContactAction publish(LiveVoice& voice, const ContactState& state) noexcept;
    /// `change` edits what the voice asks for and says whether that is another thing than before; the worker then
    /// prepares it. Any thread but the audio callback's.
    void changeProcessors(LiveVoice& voice, const std::function<bool(ProcessorSettings&)>& change);

    /// One round by hand, for an engine without worker. Not while the worker runs.
    RoundResult step();

    /// True from the first `stop` on.
    [[nodiscard]] bool isStopping() const noexcept { return stopping_.load(std::memory_order_acquire); }

    /// From the next round on. Throws std::invalid_argument for a tier that the model does not have or that is not
    /// loaded.
    void setQuality(const QualitySettings& quality);
    /// Puts a tier into its place in the model's order, for a later setQuality; one that is there already stays.
    void addTier(std::size_t tier, std::unique_ptr<inference::SegmentGenerator> generator);
    [[nodiscard]] bool hasTier(std::size_t tier) const;
    /// Any thread; waits for nobody and allocates nothing.
    [[nodiscard]] EngineStatistics statistics() const noexcept;
    [[nodiscard]] std::size_t tierCount() const noexcept { return tiers_.size(); }
    /// Any thread; waits for nobody and allocates nothing.
    [[nodiscard]] TierTimes tierTimes(std::size_t tier) const noexcept;
    /// The newest failure of a round or of the worker; empty before the first. Any thread.
    [[nodiscard]] std::string lastFailure() const;
    [[nodiscard]] const model::ModelFile& model() const noexcept { return *model_; }
    /// Registering there waits for nobody's inference.
    [[nodiscard]] MaterialLibrary& materials() noexcept { return *library_; }

private:
    /// What the worker shows of its quality control.
    struct Figures {
        std::atomic<std::uint64_t> rounds{0};
        std::atomic<std::uint64_t> segments{0};
        std::atomic<std::uint64_t> failedRounds{0};
        std::atomic<std::uint64_t> wakes{0};
        std::atomic<std::size_t> voices{0};
        std::atomic<std::size_t> tier{0};
        std::atomic<bool> measuring{false};
        std::atomic<std::uint64_t> stepsDown{0};
        std::atomic<std::uint64_t> stepsUp{0};
        std::atomic<double> budgetMs{0.0};
        std::atomic<double> lastRoundMs{0.0};
        std::atomic<bool> priorityRefused{false};
    };

    void work() noexcept;
    /// False where time for a measuring run has come.
    [[nodiscard]] bool sleep();
    void measureOnce(std::size_t tier);
    void gatherVoices();
    void showQuality() noexcept;
    void noteFailure(const char* text) noexcept;
    [[nodiscard]] bool isLoaded(const QualitySettings& quality) const;

    std::shared_ptr<const model::ModelFile> model_;
    // Places are filled under qualityMutex_, before the worker is told of them; what was filled stays.
    EngineTiers tiers_;
    LiveEngineSettings settings_;
    std::unique_ptr<MaterialLibrary> library_;

    // Held to change or copy the list, never during a round.
    std::mutex voicesMutex_;
    std::vector<std::shared_ptr<LiveVoice>> voices_;
    std::atomic<std::uint32_t> voicesMade_{0};

    // Several threads may ask; the worker takes the newest without waiting.
    mutable std::mutex qualityMutex_;
    Mailbox<QualitySettings> wantedQuality_;

    mutable std::mutex failureMutex_;
    std::string lastFailure_;
    Figures figures_;

    // Whoever steps only: the worker, or the caller of `step`.
    std::vector<std::shared_ptr<LiveVoice>> roundOwners_;
    std::vector<LiveVoice*> roundVoices_;
    InferenceRound round_;
    QualityControl quality_;
    bool looksAgain_ = false;

    std::atomic<bool> alive_{true};
    std::atomic<bool> stopping_{false};
    WakeSignal signal_;
    std::thread worker_;
};

}  // namespace haptoflow::engine
