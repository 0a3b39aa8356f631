#include "bench/subjects.hpp"

#include "bench/measurements.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <utility>

namespace haptoflow::bench {

const model::Tier& Subjects::standard() const {
    const model::Tier* named = model->findTier("standard");
    return named != nullptr ? *named : model->header().tiers[model->header().defaultTier];
}

std::unique_ptr<inference::TierGenerator> Subjects::generator(const model::ModelFile& file, const model::Tier& tier,
                                                              std::size_t batch) const {
    return inference::makeGenerator(runtime, file, tier, inference::defaultSolver(tier), batch);
}

std::unique_ptr<engine::LiveEngine> Subjects::engineWith(std::unique_ptr<inference::SegmentGenerator> generator,
                                                         bool hasWorker, const skeleton::NativeParts& native) const {
    engine::LiveEngineSettings settings;
    settings.quality.fixedTier = 0;
    settings.updateRateHz = updateRateHz;
    settings.seed = seed;
    settings.hasWorker = hasWorker;
    settings.native = native;
    engine::EngineTiers tiers;
    tiers.push_back(std::move(generator));
    return std::make_unique<engine::LiveEngine>(model, std::move(tiers), 0, settings);
}

std::unique_ptr<engine::LiveEngine> Subjects::standardEngine(bool hasWorker) const {
    return engineWith(generator(*model, standard(), defaultBatch), hasWorker);
}

Hand::Hand(const model::ModelFile& model)
    : speedMps_(model.header().speedMps), forceNewtons_(model.header().forceNewtons) {
    const auto add = [this](std::size_t index) {
        const auto label = static_cast<std::uint32_t>(index);
        if (labels_.size() < maximumLabels && std::ranges::find(labels_, label) == labels_.end()) {
            labels_.push_back(label);
        }
    };
    if (model.header().skeleton) {
        for (std::size_t label = 0; label < model.header().labels.size(); ++label) {
            add(label);
        }
    }
    for (const model::SeedEntry& seed : model.header().seeds) {
        add(seed.label);
    }
    std::ranges::sort(labels_);
}

engine::ContactState Hand::sliding(std::uint32_t touch, std::size_t place, double speedShare) const {
    engine::ContactState state;
    state.touching = true;
    state.touchCounter = touch;
    state.velocityMps = {static_cast<float>(speedMps_.at(speedShare)), 0.0F};
    state.forceNewtons = static_cast<float>(forceNewtons_.at(0.3));
    state.material.add(label(place), 1.0F);
    return state;
}

engine::ContactState Hand::lifted(std::uint32_t touch) {
    engine::ContactState state;
    state.touchCounter = touch;
    return state;
}

namespace {

/// Everything that a host has open while it plays. Creating a generator runs its graphs once, so their memory is
/// included.
struct OpenEngine {
    std::unique_ptr<engine::LiveEngine> engine;
    std::shared_ptr<engine::LiveVoice> voice;
};

OpenEngine openEngine(const Subjects& subjects) {
    engine::EngineTiers tiers;
    for (const model::Tier& tier : subjects.model->header().tiers) {
        tiers.push_back(subjects.generator(*subjects.model, tier, defaultBatch));
    }
    engine::LiveEngineSettings settings;
    settings.quality.fixedTier = subjects.model->header().defaultTier;
    OpenEngine open;
    open.engine =
        std::make_unique<engine::LiveEngine>(subjects.model, std::move(tiers), *settings.quality.fixedTier, settings);
    open.voice = open.engine->addVoice(outputRateHz);
    return open;
}

std::shared_ptr<const model::ModelFile> readModel(const std::filesystem::path& path) {
    return std::make_shared<const model::ModelFile>(model::ModelFile::read(path));
}

std::size_t readPlainly(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<char> bytes(static_cast<std::size_t>(std::max<std::streamoff>(file.tellg(), 0)));
    file.seekg(0);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return static_cast<std::size_t>(file.gcount());
}

}  // namespace

Subjects openSubjects(const SubjectFiles& files, std::uint64_t seed, nlohmann::ordered_json& report) {
    Subjects subjects;
    subjects.seed = seed;
    std::array<double, 4> resident{residentMebibytes()};
    const double runtimeSeconds = secondsOf([&] { subjects.runtime = inference::Runtime::open(files.runtimeLibrary); });
    resident[1] = residentMebibytes();
    const double modelSeconds = secondsOf([&] { subjects.model = readModel(files.model); });
    resident[2] = residentMebibytes();
    OpenEngine open;
    const double engineSeconds = secondsOf([&] { open = openEngine(subjects); });
    resident[3] = residentMebibytes();
    if (!files.paperModel.empty()) {
        subjects.paper = readModel(files.paperModel);
    }
    const double fileMebibytes = static_cast<double>(subjects.model->byteCount()) / (1024.0 * 1024.0);
    const double memory = rounded(resident[3] - resident[0]);
    report["memory_mib"] = memory;
    report["memory"] = {{"runtime_mib", rounded(resident[1] - resident[0])},
                        {"model_mib", rounded(resident[2] - resident[1])},
                        {"engine_mib", rounded(resident[3] - resident[2])},
                        {"model_file_mib", rounded(fileMebibytes)},
                        {"ratio", ratioOf(memory, rounded(fileMebibytes))}};
    report["load"] = {{"first",
                       {{"runtime_ms", rounded(runtimeSeconds * milliseconds)},
                        {"model_ms", rounded(modelSeconds * milliseconds)},
                        {"engine_ms", rounded(engineSeconds * milliseconds)}}}};
    return subjects;
}

void measureLoads(const SubjectFiles& files, const Subjects& subjects, const BenchPlan& plan, const Advance& advance,
                  nlohmann::ordered_json& report) {
    std::vector<double> plain;
    std::vector<double> model;
    std::vector<double> engine;
    std::vector<double> both;
    for (std::size_t load = 0; load < plan.loads(); ++load) {
        std::size_t bytes = 0;
        plain.push_back(secondsOf([&] { bytes = readPlainly(files.model); }));
        if (bytes != subjects.model->byteCount()) {
            throw MeasurementError(files.model.string() + ": changed while it was measured");
        }
        Subjects again = subjects;
        model.push_back(secondsOf([&] { again.model = readModel(files.model); }));
        engine.push_back(secondsOf([&] { (void)openEngine(again); }));
        both.push_back(model.back() + engine.back());
        advance(static_cast<double>(load + 1) / static_cast<double>(plan.loads()));
    }
    nlohmann::ordered_json whole = toJson(distributionOf(both), milliseconds);
    const nlohmann::ordered_json reading = toJson(distributionOf(plain), milliseconds);
    report["load_ms"] = whole["p50"];
    nlohmann::ordered_json& load = report["load"];
    load["again"] = whole;
    load["again"]["model"] = toJson(distributionOf(model), milliseconds);
    load["again"]["engine"] = toJson(distributionOf(engine), milliseconds);
    load["plain_read"] = reading;
    load["ratio"] = ratioOf(whole["p50"].get<double>(), reading["p50"].get<double>());
}

}  // namespace haptoflow::bench
