#include "engine/material_library.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>

namespace haptoflow::engine {
namespace {

static_assert(model::textureSize == model::embeddingSize - 2 * inference::ribCount);

std::optional<inference::PreparedTone> toneOf(const model::Label& label) {
    return label.tone ? std::optional<inference::PreparedTone>(*label.tone) : std::nullopt;
}

}  // namespace

const Ingredient& Ingredients::heaviest() const noexcept {
    return *std::ranges::max_element(all(), {}, &Ingredient::weight);
}

double Ingredients::totalWeight() const noexcept {
    double total = 0.0;
    for (const Ingredient& each : all()) {
        total += each.weight;
    }
    return total;
}

float Ingredients::levelMps2(const std::array<float, 3>& motion) const noexcept {
    double sum = 0.0;
    for (const Ingredient& each : all()) {
        sum += each.weight * each.material->logLevel(motion);
    }
    return static_cast<float>(std::exp(sum / totalWeight()));
}

MaterialLibrary::MaterialLibrary(const model::ModelFile& model, inference::LevelEstimator& estimator,
                                 const inference::LoadLimits& limits)
    : model_(model), grid_(model.header()) {
    const auto& labels = model.header().labels;
    std::vector<std::span<const float, model::embeddingSize>> embeddings;
    // The table of each embedding row, and of each label.
    std::unordered_map<std::size_t, std::size_t> tableOfRow;
    std::vector<std::size_t> tables;
    for (std::size_t label = 0; label < labels.size(); ++label) {
        const auto [known, isNew] = tableOfRow.emplace(labels[label].embeddingRow, embeddings.size());
        if (isNew) {
            embeddings.push_back(model.embedding(label));
        }
        tables.push_back(known->second);
    }
    graphLevels_ = tabulateLevels(grid_, embeddings, estimator, limits);
    for (std::size_t label = 0; label < labels.size(); ++label) {
        const auto table = std::span(std::as_const(graphLevels_)).subspan(tables[label] * LevelGrid::points);
        labels_.push_back({.label = &labels[label],
                           .embedding = model.embedding(label),
                           .pieceOffsets = model.pieceOffsets(label),
                           .grid = &grid_,
                           .graphLevels = table.first<LevelGrid::points>(),
                           .tone = toneOf(labels[label]),
                           .seeds = {}});
    }
    const auto& seeds = model.header().seeds;
    for (std::size_t seed = 0; seed < seeds.size(); ++seed) {
        const model::SeedEntry& entry = seeds[seed];
        labels_[entry.label].seeds.push_back({.velocityMps = entry.velocityMps,
                                              .forceNewtons = entry.forceNewtons,
                                              .ribPhase = entry.ribPhase,
                                              .gain = entry.gain,
                                              .samples = model.seed(seed)});
    }
}

std::unique_ptr<const MaterialLibrary::Registered> MaterialLibrary::prepare(model::MaterialFile material,
                                                                            const LevelSource& levels) const {
    model::requireSpace(material, model_.header());
    auto made = std::make_unique<Registered>();
    made->file = std::move(material);
    PreparedMaterial& known = made->known;
    known.label = &made->file.label;
    known.embedding = made->file.embedding;
    known.grid = &grid_;
    if (!made->file.label.level) {
        const std::array embeddings{known.embedding};
        made->graphLevels = tabulateLevels(grid_, embeddings, levels());
        known.graphLevels = std::span(std::as_const(made->graphLevels)).first<LevelGrid::points>();
    }
    known.tone = toneOf(made->file.label);
    for (const model::MaterialSeed& seed : made->file.seeds) {
        known.seeds.push_back({.velocityMps = seed.velocityMps,
                               .forceNewtons = seed.forceNewtons,
                               .ribPhase = seed.ribPhase,
                               .samples = seed.samples});
    }
    if (known.seeds.empty()) {
        known.seeds = labels_[model_.nearestLabel(known.embedding)].seeds;
    }
    return made;
}

std::size_t MaterialLibrary::add(model::MaterialFile material, const LevelSource& levels) {
    const std::lock_guard lock(mutex_);
    const std::size_t place = count_.load(std::memory_order_relaxed);
    if (place == maximumRegistered) {
        throw std::invalid_argument("all " + std::to_string(maximumRegistered) +
                                    " materials are registered: replace one of them");
    }
    owned_[place] = prepare(std::move(material), levels);
    visible_[place].store(owned_[place].get(), std::memory_order_release);
    count_.store(place + 1, std::memory_order_release);
    return labels_.size() + place;
}

void MaterialLibrary::replace(std::size_t index, model::MaterialFile material, const LevelSource& levels) {
    const std::lock_guard lock(mutex_);
    const std::size_t place = placeOf(index);
    std::unique_ptr<const Registered> fresh = prepare(std::move(material), levels);
    visible_[place].store(fresh.get());
    waitForReaders();
    owned_[place] = std::move(fresh);
}

void MaterialLibrary::showLabel(std::size_t index, const std::function<void(const model::Label&)>& look) const {
    const std::lock_guard lock(mutex_);
    look(owned_[placeOf(index)]->file.label);
}

std::size_t MaterialLibrary::placeOf(std::size_t index) const {
    const std::size_t count = registeredCount();
    if (index < labels_.size() || index - labels_.size() >= count) {
        throw std::invalid_argument("index " + std::to_string(index) + ": the model has " +
                                    std::to_string(labels_.size()) + " labels, and " + std::to_string(count) +
                                    " materials are registered behind them");
    }
    return index - labels_.size();
}

const PreparedMaterial* MaterialLibrary::find(std::uint32_t index) const noexcept {
    if (index < labels_.size()) {
        return &labels_[index];
    }
    const std::size_t place = index - labels_.size();
    // Sequentially consistent, like the counter of readers: if `replace` saw no reader, this load sees its replacement.
    const Registered* registered = place < maximumRegistered ? visible_[place].load() : nullptr;
    return registered == nullptr ? nullptr : &registered->known;
}

void MaterialLibrary::waitForReaders() noexcept {
    // Twice, because a reader may have loaded the open phase before it increments the counter.
    for (int times = 0; times < 2; ++times) {
        const std::uint32_t closed = openPhase_.fetch_xor(1U);
        while (readers_[closed].load() != 0) {
            std::this_thread::sleep_for(std::chrono::microseconds(20));
        }
    }
}

MaterialLibrary::ReadScope::ReadScope(const MaterialLibrary& library) noexcept
    : library_(library), readers_(library.readers_[library.openPhase_.load()]) {
    readers_.fetch_add(1);
}

MaterialLibrary::ReadScope::~ReadScope() {
    readers_.fetch_sub(1);
}

Ingredients MaterialLibrary::ReadScope::ingredients(const MaterialBlend& blend) const noexcept {
    Ingredients found;
    for (std::size_t i = 0; i < std::min<std::size_t>(blend.count, MaterialBlend::capacity); ++i) {
        const std::uint32_t label = blend.labels[i];
        const float weight = blend.weights[i];
        const PreparedMaterial* material = library_.find(label);
        if (material == nullptr || !(weight > 0.0F)) {
            continue;
        }
        const auto known = std::span(found.entries).first(found.count);
        const auto same = std::ranges::find(known, label, &Ingredient::index);
        if (same != known.end()) {
            same->weight += static_cast<double>(weight);
            continue;
        }
        found.entries[found.count] = {.material = material, .index = label, .weight = weight};
        ++found.count;
    }
    if (found.count == 0) {
        found.entries[0] = {.material = &library_.labels_.front(), .index = 0, .weight = 1.0};
        found.count = 1;
    }
    return found;
}

}  // namespace haptoflow::engine
