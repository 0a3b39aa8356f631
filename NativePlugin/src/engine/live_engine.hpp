#pragma once

#include "dsp/limiter.hpp"
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
    /// Indices of the tiers, the least accurate first; empty for the model's order.
    std::vector<std::size_t> tiersByAccuracy{};
    /// Contact states per second; sets the interval of measuring runs.
    double updateRateHz = defaultUpdateRateHz;
    float fullScaleMps2 = dsp::SoftLimiter::defaultFullScaleMps2;
    /// Key of all noise.
    std::uint64_t seed = 1;
    /// 0 to 50 ms; empty if each voice estimates its lead.
    std::optional<double> fixedLeadMs;
    /// Without a worker, the caller calls `step`.
    bool hasWorker = true;
    /// The skeleton of the model, to be shared with its generators; empty, it is read from the model.
    skeleton::NativeParts native{};
};

/// Throws std::invalid_argument for automatic quality without a worker, which alone measures the tiers: an engine
/// without worker renders the same samples on every machine.
void requireServedQuality(const QualitySettings& quality, bool hasWorker);

/// The model's tiers in the model's order; null for a tier that is not loaded.
using EngineTiers = std::vector<std::unique_ptr<inference::SegmentGenerator>>;

struct TierTimes {
    std::size_t runs = 0;
    double medianMs = 0.0;
    double percentile99Ms = 0.0;
};

/// Statistics of an engine, for display. The worker writes and any thread reads.
struct EngineStatistics {
    std::atomic<std::uint64_t> rounds{0};
    std::atomic<std::uint64_t> segments{0};
    std::atomic<std::uint64_t> failedRounds{0};
    /// Number of times that the worker woke up.
    std::atomic<std::uint64_t> wakes{0};
    std::atomic<std::size_t> voices{0};
    std::atomic<std::size_t> tier{0};
    std::atomic<bool> measuring{false};
    std::atomic<std::uint64_t> stepsDown{0};
    std::atomic<std::uint64_t> stepsUp{0};
    std::atomic<double> budgetMs{0.0};
    std::atomic<double> lastRoundMs{0.0};
    std::atomic<bool> workerAlive{true};
    /// The system refused the worker a raised priority.
    std::atomic<bool> priorityRefused{false};
};

/// All voices of one model, and the worker thread that generates their segments. The worker sleeps while nothing is
/// published. It holds no lock during inference, so adding, removing and reading voices never waits for inference.
class LiveEngine {
public:
    /// `tiers` holds at least one loaded tier. Automatic quality needs all tiers, a fixed quality its own. Runs the
    /// level graph of the first loaded tier for MaterialLibrary. Throws std::invalid_argument for settings out of range
    /// or a tier that is not loaded, inference::InferenceError, inference::LoadCancelled, std::system_error.
    LiveEngine(std::shared_ptr<const model::ModelFile> model, EngineTiers tiers, std::size_t startTier,
               const LiveEngineSettings& settings, const inference::LoadLimits& limits = {});
    LiveEngine(const LiveEngine&) = delete;
    LiveEngine& operator=(const LiveEngine&) = delete;
    /// Ends the worker after its present round. Voices fall silent within a block and 5 ms.
    ~LiveEngine();

    /// Ends the worker permanently. May be called twice.
    void stop() noexcept;

    /// Adds a voice, which takes part from the next round on. The voice must be destroyed before the engine.
    [[nodiscard]] std::shared_ptr<LiveVoice> addVoice(double outputRateHz);
    /// Removes a voice. A round in progress keeps it alive until the round ends.
    void removeVoice(const LiveVoice& voice) noexcept;

    /// Publishes a contact state on a voice of this engine and wakes the worker if needed. Wait-free.
    ContactAction publish(LiveVoice& voice, const ContactState& state) noexcept;
    /// Any thread. The acceleration that is +-1 at every voice's output.
    [[nodiscard]] double fullScaleMps2() const noexcept { return static_cast<double>(settings_.fullScaleMps2); }
    /// `change` edits the voice's settings and returns whether they have changed; the worker then prepares the new
    /// processors. Any thread except the audio callback's.
    void changeProcessors(LiveVoice& voice, const std::function<bool(ProcessorSettings&)>& change);

    /// Runs one round on the calling thread, for an engine without a worker.
    RoundResult step();

    /// The worker's own loop, for a host that starts the threads (startsThreads is false): waits until there is work,
    /// at most this time, and does it. Returns false once the worker has ended, by `stop` or by a failure.
    [[nodiscard]] bool turn(double maximumWaitMs) noexcept;
    /// Ends the wait of a running `turn`. Any thread but an audio callback's.
    void wake() noexcept { signal_.post(); }

    /// True after the first call of `stop`.
    [[nodiscard]] bool isStopping() const noexcept { return stopping_.load(std::memory_order_acquire); }

    /// Takes effect with the next round. Throws std::invalid_argument for a tier that the model does not have or that
    /// is not loaded, and for automatic quality without a worker.
    void setQuality(const QualitySettings& quality);
    /// Any thread; wait-free, allocates nothing.
    [[nodiscard]] const EngineStatistics& statistics() const noexcept { return figures_; }
    [[nodiscard]] std::size_t tierCount() const noexcept { return tiers_.size(); }
    /// Any thread; wait-free, allocates nothing.
    [[nodiscard]] TierTimes tierTimes(std::size_t tier) const noexcept;
    /// Message of the newest failure of a round or of the worker; empty before the first. Any thread.
    [[nodiscard]] std::string lastFailure() const;
    [[nodiscard]] const model::ModelFile& model() const noexcept { return *model_; }
    /// Registering a material there does not wait for inference.
    [[nodiscard]] MaterialLibrary& materials() noexcept { return *library_; }

private:
    void work() noexcept;
    /// Returns false when it is time for a measuring run.
    [[nodiscard]] bool sleep(double maximumWaitMs);
    void workOnce(double maximumWaitMs);
    void measureOnce(std::size_t tier);
    void gatherVoices();
    void publishQuality() noexcept;
    void noteFailure(const char* text) noexcept;
    [[nodiscard]] bool isLoaded(const QualitySettings& quality) const;

    std::shared_ptr<const model::ModelFile> model_;
    const EngineTiers tiers_;
    LiveEngineSettings settings_;
    std::unique_ptr<MaterialLibrary> library_;

    // Held while the list is changed or copied, never during a round.
    std::mutex voicesMutex_;
    std::vector<std::shared_ptr<LiveVoice>> voices_;
    std::atomic<std::uint32_t> voiceCount_{0};

    // Several threads may set the quality; the worker fetches the newest without waiting.
    std::mutex qualityMutex_;
    Mailbox<QualitySettings> requestedQuality_;

    mutable std::mutex failureMutex_;
    std::string lastFailure_;
    EngineStatistics figures_;

    // Used only by the thread that runs rounds: the worker, or the caller of `step`.
    std::vector<std::shared_ptr<LiveVoice>> roundOwners_;
    std::vector<LiveVoice*> roundVoices_;
    InferenceRound round_;
    QualityControl quality_;
    bool mustPoll_ = false;

    std::atomic<bool> stopping_{false};
    WakeSignal signal_;
    std::thread worker_;
};

}  // namespace haptoflow::engine
