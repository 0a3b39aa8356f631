#include "capi/handles.hpp"
#include "capi/voice_table.hpp"
#include "dsp/limiter.hpp"
#include "inference/graph_session.hpp"
#include "inference/tier_generator.hpp"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace haptoflow;
using namespace haptoflow::capi;

namespace {

constexpr uint32_t defaultBatchVoices = 8;
constexpr double defaultFullScaleMps2 = HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2;
static_assert(defaultFullScaleMps2 == dsp::SoftLimiter::defaultFullScaleMps2);

double orDefault(double value, double usual) {
    return value == 0.0 ? usual : value;
}

/// Index in the model of the tier for a quality.
std::size_t tierOfQuality(const model::ModelHeader& header, haptoflow_quality quality) {
    const auto named = [&header](const char* name, std::size_t otherwise) {
        const auto found = std::ranges::find(header.tiers, name, &model::Tier::name);
        return found == header.tiers.end() ? otherwise : static_cast<std::size_t>(found - header.tiers.begin());
    };
    switch (quality) {
        case HAPTOFLOW_QUALITY_AUTO:
        case HAPTOFLOW_QUALITY_STANDARD:
            return named("standard", header.defaultTier);
        case HAPTOFLOW_QUALITY_DRAFT:
            return named("draft", 0);
        case HAPTOFLOW_QUALITY_SKETCH:
            return named("sketch", 0);
        default:
            throw std::invalid_argument("quality is " + std::to_string(quality) +
                                        "; expected 0 (auto), 1 (draft), 2 (standard) or 4 (sketch)");
    }
}

/// The most accurate tier that needs no ONNX Runtime, if the model has one.
std::optional<std::size_t> tierWithoutRuntime(const model::ModelHeader& header) {
    const std::vector<std::size_t> tiers = model::tiersByAccuracy(header.tiers);
    const auto found = std::find_if(tiers.rbegin(), tiers.rend(),
                                    [&header](std::size_t tier) { return !header.tiers[tier].needsOnnxRuntime(); });
    return found == tiers.rend() ? std::nullopt : std::optional(*found);
}

engine::QualitySettings qualitySettings(const model::ModelHeader& header, haptoflow_quality quality, double budgetMs,
                                        bool hasRuntime) {
    engine::QualitySettings settings;
    settings.budgetMs = budgetMs;
    const std::size_t tier = tierOfQuality(header, quality);
    if (quality != HAPTOFLOW_QUALITY_AUTO) {
        settings.fixedTier = tier;
    } else if (!hasRuntime) {
        settings.fixedTier = tierWithoutRuntime(header);
    }
    return settings;
}

engine::LiveEngineSettings engineSettings(const haptoflow_engine_options& given, const model::ModelHeader& header) {
    const double budgetShare = orDefault(given.budget_share, engine::defaultBudgetShare);
    if (!(budgetShare > 0.0 && budgetShare <= 1.0)) {
        throw std::invalid_argument("options: budget_share is " + std::to_string(budgetShare) +
                                    "; expected above 0 to 1");
    }
    engine::LiveEngineSettings settings;
    settings.updateRateHz = orDefault(given.update_rate_hz, settings.updateRateHz);
    settings.quality =
        qualitySettings(header, given.quality, 1000.0 * budgetShare / settings.updateRateHz, given.runtime != nullptr);
    settings.tiersByAccuracy = model::tiersByAccuracy(header.tiers);
    settings.fullScaleMps2 = static_cast<float>(orDefault(given.full_scale_mps2, defaultFullScaleMps2));
    settings.seed = given.seed;
    settings.hasWorker = given.without_worker == 0;
    // Before any tier is loaded.
    engine::requireServedQuality(settings.quality, settings.hasWorker);
    if (given.fixed_lead_ms != 0.0) {
        settings.fixedLeadMs = given.fixed_lead_ms;
    }
    return settings;
}

}  // namespace

haptoflow_status haptoflow_engine_create(const haptoflow_engine_options* options, haptoflow_engine** engine) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(engine, "engine");
        const auto runtime = runtimeOf(given.runtime);
        const auto open = models().get(given.model);
        const model::ModelHeader& header = open->model.header();
        const uint32_t batch = given.batch_voices != 0 ? given.batch_voices : defaultBatchVoices;
        if (batch > HAPTOFLOW_MAXIMUM_VOICES) {
            throw std::invalid_argument("options: batch_voices is " + std::to_string(batch) + "; expected 1 to 64");
        }
        auto settings = engineSettings(given, header);
        settings.native = open->native;
        const inference::LoadLimits limits = loadLimits(given.cancellation, given.probe_limit_ms);
        // Tiers of one graph share its session, because one thread at a time runs them.
        inference::SharedSessions sessions;
        engine::EngineTiers tiers(header.tiers.size());
        for (std::size_t index = 0; index < tiers.size(); ++index) {
            const model::Tier& tier = header.tiers[index];
            if (runtime != nullptr || !tier.needsOnnxRuntime() || settings.quality.fixedTier.value_or(index) == index) {
                tiers[index] = inference::makeGenerator(runtime, open->model, tier, inference::defaultSolver(tier),
                                                        batch, limits, open->native, &sessions);
            }
        }
        auto live = std::make_shared<engine::LiveEngine>(
            std::shared_ptr<const model::ModelFile>(open, &open->model), std::move(tiers),
            tierOfQuality(header, HAPTOFLOW_QUALITY_AUTO), settings, limits);
        *engine = engines().open(
            std::make_shared<OpenEngine>(std::move(live), settings.hasWorker, runtime, open, limits.probeLimitMs));
    });
}

haptoflow_status haptoflow_engine_close(haptoflow_engine** engine) {
    return guarded([&] {
        if (*require(engine, "engine") == nullptr) {
            return;
        }
        const auto open = engines().get(*engine);
        engines().close(*engine);
        *engine = nullptr;
        open->engine->stop();
        voices().closeAll(*open->engine);
    });
}

haptoflow_status haptoflow_engine_set_quality(haptoflow_engine* engine, haptoflow_quality quality) {
    return guarded([&] {
        const auto open = engines().get(engine);
        engine::LiveEngine& live = *open->engine;
        const model::ModelHeader& header = live.model().header();
        live.setQuality(qualitySettings(header, quality, live.statistics().budgetMs, open->runtime != nullptr));
    });
}

haptoflow_status haptoflow_engine_step(haptoflow_engine* engine) {
    return guarded([&] {
        const auto open = engines().get(engine);
        if (open->hasWorker) {
            throw std::invalid_argument(
                "the engine has a worker: only an engine created with without_worker is stepped");
        }
        const std::lock_guard lock(open->stepping);
        open->engine->step();
    });
}

haptoflow_status haptoflow_engine_get_statistics(const haptoflow_engine* engine,
                                                 haptoflow_engine_statistics* statistics) {
    return guarded([&] {
        const auto open = engines().get(engine);
        const engine::EngineStatistics& found = open->engine->statistics();
        haptoflow_engine_statistics content{};
        content.tier = static_cast<uint32_t>(found.tier);
        content.voices = static_cast<uint32_t>(found.voices);
        content.is_measuring = found.measuring ? 1 : 0;
        content.rounds = found.rounds;
        content.segments = found.segments;
        content.failed_rounds = found.failedRounds;
        content.wakes = found.wakes;
        content.quality_steps_down = found.stepsDown;
        content.quality_steps_up = found.stepsUp;
        content.budget_ms = found.budgetMs;
        content.last_round_ms = found.lastRoundMs;
        content.worker_is_alive = found.workerAlive ? 1 : 0;
        content.priority_was_refused = found.priorityRefused ? 1 : 0;
        writeDescriptor(statistics, content, "statistics");
    });
}

haptoflow_status haptoflow_engine_tier_times(const haptoflow_engine* engine, uint32_t index,
                                             haptoflow_tier_times* times) {
    return guarded([&] {
        const auto open = engines().get(engine);
        const engine::LiveEngine& live = *open->engine;
        if (index >= live.tierCount()) {
            throw std::invalid_argument("tier " + std::to_string(index) + " of " + std::to_string(live.tierCount()));
        }
        const engine::TierTimes found = live.tierTimes(index);
        haptoflow_tier_times content{};
        content.is_current = live.statistics().tier == index ? 1 : 0;
        content.runs = found.runs;
        content.median_ms = found.medianMs;
        content.percentile_99_ms = found.percentile99Ms;
        writeDescriptor(times, content, "times");
    });
}

haptoflow_status haptoflow_engine_last_failure(const haptoflow_engine* engine, char* text, uint64_t capacity,
                                               uint64_t* length) {
    return guarded([&] {
        (void)require(length, "length");
        const std::string failure = engines().get(engine)->engine->lastFailure();
        if (capacity > 0) {
            const auto kept = static_cast<std::size_t>(std::min<uint64_t>(failure.size(), capacity - 1));
            std::copy_n(failure.begin(), kept, require(text, "text"));
            text[kept] = '\0';
        }
        *length = failure.size();
    });
}
