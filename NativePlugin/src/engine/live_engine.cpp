#include "engine/live_engine.hpp"

#include "dsp/denormals.hpp"
#include "inference/load_limits.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace haptoflow::engine {
namespace {

constexpr double callbackPollMs = 2.0;
// Outside this range, the precision of a float no longer separates neighbouring samples.
constexpr float minimumFullScaleMps2 = 1e-3F;
constexpr float maximumFullScaleMps2 = 1e6F;

const LiveEngineSettings& checked(const LiveEngineSettings& settings) {
    if (!(settings.updateRateHz >= 1.0 && settings.updateRateHz <= 10000.0)) {
        throw std::invalid_argument("update rate is " + std::to_string(settings.updateRateHz) +
                                    " Hz; expected 1 to 10000 Hz");
    }
    if (settings.fixedLeadMs && !(*settings.fixedLeadMs >= 0.0 && *settings.fixedLeadMs <= LeadEstimator::maximumMs)) {
        throw std::invalid_argument("lead is " + std::to_string(*settings.fixedLeadMs) + " ms; expected 0 to 50 ms");
    }
    if (!(settings.quality.budgetMs > 0.0)) {
        throw std::invalid_argument("the budget for inference must be above 0 ms");
    }
    if (!(settings.fullScaleMps2 >= minimumFullScaleMps2 && settings.fullScaleMps2 <= maximumFullScaleMps2)) {
        throw std::invalid_argument("full_scale_mps2 is " + std::to_string(settings.fullScaleMps2) +
                                    "; expected 0.001 to 1000000 m/s^2");
    }
    requireServedQuality(settings.quality, settings.hasWorker);
    return settings;
}

std::shared_ptr<const model::ModelFile> checked(std::shared_ptr<const model::ModelFile> model,
                                                const EngineTiers& tiers) {
    if (model == nullptr || tiers.empty()) {
        throw std::invalid_argument("an engine needs a model and at least one tier");
    }
    return model;
}

inference::SegmentGenerator& firstLoaded(const EngineTiers& tiers) {
    const auto found = std::ranges::find_if(tiers, [](const auto& tier) { return tier != nullptr; });
    if (found == tiers.end()) {
        throw std::invalid_argument("an engine needs at least one loaded tier");
    }
    return **found;
}

}  // namespace

void requireServedQuality(const QualitySettings& quality, bool hasWorker) {
    if (!hasWorker && !quality.fixedTier) {
        throw std::invalid_argument(
            "quality: auto measures the tiers on a worker thread; an engine without worker needs a fixed quality");
    }
}

LiveEngine::LiveEngine(std::shared_ptr<const model::ModelFile> model, EngineTiers tiers, std::size_t startTier,
                       const LiveEngineSettings& settings, const inference::LoadLimits& limits)
    : model_(checked(std::move(model), tiers)),
      tiers_(std::move(tiers)),
      settings_(checked(settings)),
      library_(std::make_unique<MaterialLibrary>(*model_, firstLoaded(tiers_), limits)),
      quality_(tiers_.size(), settings.quality, startTier, settings.tiersByAccuracy) {
    settings_.native = skeleton::sharedOrRead(settings_.native, *model_);
    if (!isLoaded(settings_.quality)) {
        throw std::invalid_argument("quality: the tier is not loaded");
    }
    publishQuality();
    if constexpr (startsThreads) {
        if (settings_.hasWorker) {
            worker_ = std::thread([this] { work(); });
        }
    }
}

LiveEngine::~LiveEngine() {
    stop();
}

void LiveEngine::stop() noexcept {
    stopping_.store(true, std::memory_order_release);
    signal_.post();
    if (worker_.joinable()) {
        worker_.join();
    }
    figures_.workerAlive.store(false, std::memory_order_release);
}

std::shared_ptr<LiveVoice> LiveEngine::addVoice(double outputRateHz) {
    LiveVoiceSettings settings;
    settings.planner.seed = settings_.seed;
    settings.planner.voice = voiceCount_.fetch_add(1);
    if (settings_.fixedLeadMs) {
        settings.planner.fixedLeadSamples = LeadEstimator::samplesOf(*settings_.fixedLeadMs);
    }
    settings.outputRateHz = outputRateHz;
    settings.fullScaleMps2 = settings_.fullScaleMps2;
    settings.isRealTime = settings_.hasWorker;
    settings.native = settings_.native;
    auto voice = std::make_shared<LiveVoice>(*library_, figures_.workerAlive, settings);
    const std::lock_guard lock(voicesMutex_);
    voices_.push_back(voice);
    figures_.voices = voices_.size();
    return voice;
}

void LiveEngine::removeVoice(const LiveVoice& voice) noexcept {
    const std::lock_guard lock(voicesMutex_);
    std::erase_if(voices_, [&voice](const auto& each) { return each.get() == &voice; });
    figures_.voices = voices_.size();
}

void LiveEngine::gatherVoices() {
    {
        const std::lock_guard lock(voicesMutex_);
        roundOwners_.assign(voices_.begin(), voices_.end());
    }
    roundVoices_.clear();
    std::ranges::transform(roundOwners_, std::back_inserter(roundVoices_), [](const auto& each) { return each.get(); });
}

ContactAction LiveEngine::publish(LiveVoice& voice, const ContactState& state) noexcept {
    const ContactAction action = voice.publisher.publish(state);
    const VoiceChannels& channels = voice.channels;
    const bool wantsOutput = channels.requestedRateHz.load(std::memory_order_relaxed) != 0.0 ||
                             channels.lacksProcessors.load(std::memory_order_relaxed) || channels.processors.hasUsed();
    if (action != ContactAction::rest || wantsOutput) {
        signal_.post();
    }
    return action;
}

void LiveEngine::changeProcessors(LiveVoice& voice, const std::function<bool(ProcessorSettings&)>& change) {
    if (voice.channels.changeProcessors(change)) {
        signal_.post();
    }
}

RoundResult LiveEngine::step() {
    const dsp::ScopedFlushDenormals flush;
    if (requestedQuality_.fetch()) {
        quality_.setSettings(requestedQuality_.current());
    }
    const std::size_t tier = quality_.tier();
    gatherVoices();
    RoundResult result = round_.run(roundVoices_, *tiers_[tier]);
    roundOwners_.clear();
    if (result.voices > 0) {
        ++figures_.rounds;
        figures_.segments += result.segments;
        figures_.lastRoundMs = result.milliseconds;
        if (result.failed) {
            ++figures_.failedRounds;
            noteFailure(result.failure.c_str());
        } else {
            quality_.recordRound(result.milliseconds, result.voices, result.segments);
        }
    }
    publishQuality();
    return result;
}

void LiveEngine::publishQuality() noexcept {
    figures_.tier = quality_.tier();
    figures_.measuring = quality_.tierToMeasure().has_value();
    figures_.stepsDown = quality_.stepsDown();
    figures_.stepsUp = quality_.stepsUp();
    figures_.budgetMs = quality_.budgetMs();
}

void LiveEngine::noteFailure(const char* text) noexcept {
    try {
        const std::lock_guard lock(failureMutex_);
        lastFailure_ = text;
    } catch (const std::exception&) {
        // Without memory for the text, the counters still record the failure.
    }
}

void LiveEngine::work() noexcept {
    nameThisThread("haptoflow");
    figures_.priorityRefused = !raiseThisThreadsPriority();
    while (turn(std::numeric_limits<double>::infinity())) {
    }
}

bool LiveEngine::turn(double maximumWaitMs) noexcept {
    try {
        if (!stopping_.load(std::memory_order_acquire)) {
            workOnce(maximumWaitMs);
        }
        if (!stopping_.load(std::memory_order_acquire)) {
            return true;
        }
    } catch (const std::exception& error) {
        // Out of memory, or the system refused a lock: the voices fall silent because the worker has ended.
        noteFailure(error.what());
    }
    figures_.workerAlive.store(false, std::memory_order_release);
    return false;
}

void LiveEngine::workOnce(double maximumWaitMs) {
    if (!sleep(maximumWaitMs)) {
        if (const auto tier = quality_.tierToMeasure()) {
            measureOnce(*tier);
            return;
        }
    }
    if (!stopping_.load(std::memory_order_acquire)) {
        ++figures_.wakes;
        const RoundResult result = step();
        mustPoll_ = result.mustPoll;
    }
}

bool LiveEngine::sleep(double maximumWaitMs) {
    // The callback cannot wake the worker, so the worker polls.
    if (mustPoll_) {
        (void)signal_.waitFor(std::min(callbackPollMs, maximumWaitMs));
        return true;
    }
    if (quality_.tierToMeasure()) {
        return signal_.waitFor(std::min(1000.0 / settings_.updateRateHz, maximumWaitMs));
    }
    if (maximumWaitMs < std::numeric_limits<double>::infinity()) {
        (void)signal_.waitFor(maximumWaitMs);
        return true;
    }
    signal_.wait();
    return true;
}

void LiveEngine::measureOnce(std::size_t tier) {
    const dsp::ScopedFlushDenormals flush;
    constexpr std::array<float, inference::segmentSamples> silence{};
    inference::SegmentRequest request{.embedding = {},
                                      .motion = {static_cast<float>(model_->header().speedMps.maximum) * 0.5F, 0.0F,
                                                 static_cast<float>(model_->header().forceNewtons.maximum) * 0.5F},
                                      .previous = silence,
                                      .noise = silence};
    std::ranges::copy(model_->embedding(0), request.embedding.begin());
    std::array<float, inference::segmentSamples> segment{};
    // A tier that cannot run gets a time above any budget, so that it is never chosen.
    double milliseconds = 1e9;
    const auto began = std::chrono::steady_clock::now();
    try {
        tiers_[tier]->generate(std::span(&request, 1), segment);
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
        milliseconds = spent.count();
    } catch (const inference::InferenceError& error) {
        noteFailure(error.what());
    }
    quality_.recordMeasurement(tier, milliseconds);
    publishQuality();
}

void LiveEngine::setQuality(const QualitySettings& quality) {
    if (!(quality.budgetMs > 0.0) || (quality.fixedTier && *quality.fixedTier >= tiers_.size())) {
        throw std::invalid_argument("quality: expected a tier of the model and a budget above 0 ms");
    }
    requireServedQuality(quality, settings_.hasWorker);
    if (!isLoaded(quality)) {
        const std::string tier =
            quality.fixedTier ? '"' + model_->header().tiers[*quality.fixedTier].name + '"' : "auto";
        throw std::invalid_argument("quality: " + tier + " needs ONNX Runtime, which this engine was created without");
    }
    {
        const std::lock_guard lock(qualityMutex_);
        requestedQuality_.draft() = quality;
        requestedQuality_.post();
    }
    signal_.post();
}

bool LiveEngine::isLoaded(const QualitySettings& quality) const {
    if (quality.fixedTier) {
        return *quality.fixedTier < tiers_.size() && tiers_[*quality.fixedTier] != nullptr;
    }
    return std::ranges::all_of(tiers_, [](const auto& tier) { return tier != nullptr; });
}

TierTimes LiveEngine::tierTimes(std::size_t tier) const noexcept {
    if (tier >= tiers_.size()) {
        return {};
    }
    const RunTimes& times = quality_.times(tier);
    return {.runs = times.count(), .medianMs = times.percentile(0.5), .percentile99Ms = times.percentile(0.99)};
}

std::string LiveEngine::lastFailure() const {
    const std::lock_guard lock(failureMutex_);
    return lastFailure_;
}

}  // namespace haptoflow::engine
