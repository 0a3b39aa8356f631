#include "engine/live_engine.hpp"

#include "dsp/denormals.hpp"
#include "engine/thread_priority.hpp"
#include "inference/inference_error.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <exception>
#include <stdexcept>

namespace haptoflow::engine {
namespace {

constexpr double largestLeadMs = 50.0;
constexpr double callbackLookMs = 2.0;

const LiveEngineSettings& checked(const LiveEngineSettings& settings) {
    if (!(settings.updateRateHz >= 1.0 && settings.updateRateHz <= 10000.0)) {
        throw std::invalid_argument("update rate is " + std::to_string(settings.updateRateHz) +
                                    " Hz; expected 1 to 10000 Hz");
    }
    if (settings.fixedLeadMs && !(*settings.fixedLeadMs >= 0.0 && *settings.fixedLeadMs <= largestLeadMs)) {
        throw std::invalid_argument("lead is " + std::to_string(*settings.fixedLeadMs) + " ms; expected 0 to 50 ms");
    }
    if (!(settings.quality.budgetMs > 0.0)) {
        throw std::invalid_argument("the budget for inference must be above 0 ms");
    }
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
        throw std::invalid_argument("an engine needs at least one tier that is loaded");
    }
    return **found;
}

}  // namespace

LiveEngine::LiveEngine(std::shared_ptr<const model::ModelFile> model, EngineTiers tiers, std::size_t startTier,
                       const LiveEngineSettings& settings, const inference::LoadLimits& limits)
    : model_(checked(std::move(model), tiers)),
      tiers_(std::move(tiers)),
      settings_(checked(settings)),
      levels_(std::make_unique<OnsetLevels>(*model_, firstLoaded(tiers_), limits)),
      quality_(tiers_.size(), settings.quality, startTier) {
    if (!isLoaded(settings_.quality)) {
        throw std::invalid_argument("quality: a tier that is not loaded");
    }
    if (settings_.hasWorker) {
        worker_ = std::thread([this] { work(); });
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
    alive_.store(false, std::memory_order_release);
}

std::shared_ptr<LiveVoice> LiveEngine::addVoice(double outputRateHz) {
    const std::lock_guard lock(voicesMutex_);
    LiveVoiceSettings settings;
    settings.planner.seed = settings_.seed;
    settings.planner.voice = voicesMade_;
    if (settings_.fixedLeadMs) {
        settings.planner.fixedLeadSamples =
            static_cast<std::int64_t>(std::ceil(*settings_.fixedLeadMs * inference::waveformRateHz / 1000.0));
    }
    settings.outputRateHz = outputRateHz;
    settings.fullScaleMps2 = settings_.fullScaleMps2;
    auto voice = std::make_shared<LiveVoice>(*model_, *levels_, alive_, settings);
    voices_.push_back(voice);
    roundVoices_.reserve(voices_.size());
    ++voicesMade_;
    const std::lock_guard figuresLock(figuresMutex_);
    figures_.voices = voices_.size();
    return voice;
}

void LiveEngine::removeVoice(const LiveVoice& voice) noexcept {
    const std::lock_guard lock(voicesMutex_);
    std::erase_if(voices_, [&voice](const auto& each) { return each.get() == &voice; });
    const std::lock_guard figuresLock(figuresMutex_);
    figures_.voices = voices_.size();
}

ContactAction LiveEngine::publish(LiveVoice& voice, const ContactState& state) noexcept {
    const ContactAction action = voice.publisher.publish(state);
    const bool wantsOutput = voice.channels.wantedRateHz.load(std::memory_order_relaxed) != 0.0;
    if (action != ContactAction::rest || wantsOutput) {
        signal_.post();
    }
    return action;
}

RoundResult LiveEngine::step() {
    const std::lock_guard lock(voicesMutex_);
    const dsp::ScopedFlushDenormals flush;
    std::size_t tier = 0;
    {
        const std::lock_guard figuresLock(figuresMutex_);
        tier = quality_.tier();
    }
    roundVoices_.clear();
    for (const auto& voice : voices_) {
        roundVoices_.push_back(voice.get());
    }
    const RoundResult result = round_.run(roundVoices_, *tiers_[tier]);
    const std::lock_guard figuresLock(figuresMutex_);
    if (result.voices > 0) {
        ++figures_.rounds;
        figures_.segments += result.segments;
        figures_.lastRoundMs = result.milliseconds;
        if (result.failed) {
            ++figures_.failedRounds;
        } else if (tier == quality_.tier()) {
            quality_.ran(result.milliseconds, result.voices);
        }
    }
    return result;
}

std::optional<std::size_t> LiveEngine::tierToMeasure() const {
    const std::lock_guard lock(figuresMutex_);
    return quality_.tierToMeasure();
}

void LiveEngine::work() noexcept {
    nameThisThread("haptoflow");
    (void)raiseThisThreadsPriority();
    try {
        while (!stopping_.load(std::memory_order_acquire)) {
            if (!sleep()) {
                if (const auto tier = tierToMeasure()) {
                    measureOnce(*tier);
                    continue;
                }
            }
            if (!stopping_.load(std::memory_order_acquire)) {
                wakes_.fetch_add(1, std::memory_order_relaxed);
                const RoundResult result = step();
                looksAgain_ = result.looksAgain;
            }
        }
    } catch (const std::exception&) {
        // Out of memory, or a lock that the system refuses: the voices see that nobody generates any more.
    }
    alive_.store(false, std::memory_order_release);
}

bool LiveEngine::sleep() {
    // The callback wakes nobody.
    if (looksAgain_) {
        (void)signal_.waitFor(callbackLookMs);
        return true;
    }
    if (tierToMeasure()) {
        return signal_.waitFor(1000.0 / settings_.updateRateHz);
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
    // A tier that cannot run is never chosen: it costs more than any budget.
    double milliseconds = 1e9;
    const auto began = std::chrono::steady_clock::now();
    try {
        tiers_[tier]->generate(std::span(&request, 1), segment);
        const std::chrono::duration<double, std::milli> spent = std::chrono::steady_clock::now() - began;
        milliseconds = spent.count();
    } catch (const inference::InferenceError&) {
    }
    const std::lock_guard lock(figuresMutex_);
    quality_.measured(tier, milliseconds);
}

void LiveEngine::setQuality(const QualitySettings& quality) {
    if (!(quality.budgetMs > 0.0) || (quality.fixedTier && *quality.fixedTier >= tiers_.size())) {
        throw std::invalid_argument("quality: a tier that the model has, and a budget above 0 ms");
    }
    {
        const std::lock_guard lock(figuresMutex_);
        if (!isLoaded(quality)) {
            throw std::invalid_argument("quality: a tier that is not loaded");
        }
        quality_.setSettings(quality);
    }
    signal_.post();
}

bool LiveEngine::isLoaded(const QualitySettings& quality) const {
    if (quality.fixedTier) {
        return *quality.fixedTier < tiers_.size() && tiers_[*quality.fixedTier] != nullptr;
    }
    return std::ranges::all_of(tiers_, [](const auto& tier) { return tier != nullptr; });
}

void LiveEngine::addTier(std::size_t tier, std::unique_ptr<inference::SegmentGenerator> generator) {
    const std::lock_guard lock(figuresMutex_);
    if (tiers_.at(tier) == nullptr) {
        tiers_[tier] = std::move(generator);
    }
}

bool LiveEngine::hasTier(std::size_t tier) const {
    const std::lock_guard lock(figuresMutex_);
    return tiers_.at(tier) != nullptr;
}

EngineStatistics LiveEngine::statistics() const {
    const std::lock_guard lock(figuresMutex_);
    EngineStatistics statistics = figures_;
    statistics.wakes = wakes_.load(std::memory_order_relaxed);
    statistics.tier = quality_.tier();
    statistics.measuring = quality_.tierToMeasure().has_value();
    statistics.stepsDown = quality_.stepsDown();
    statistics.stepsUp = quality_.stepsUp();
    statistics.budgetMs = quality_.budgetMs();
    for (std::size_t tier = 0; tier < tiers_.size(); ++tier) {
        const RunTimes& times = quality_.times(tier);
        statistics.tiers.push_back({times.count(), times.percentile(0.5), times.percentile(0.99)});
    }
    return statistics;
}

}  // namespace haptoflow::engine
