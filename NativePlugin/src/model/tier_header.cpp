#include "model/header_node.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace haptoflow::model {
namespace {

constexpr std::int64_t maximumParameters = INT64_C(1) << 32;

template <typename Value>
using Word = std::pair<std::string_view, Value>;

constexpr std::array<Word<TierKind>, 5> kindWords = {{{"flow", TierKind::flow},
                                                      {"average-velocity", TierKind::averageVelocity},
                                                      {"direct", TierKind::direct},
                                                      {"skeleton", TierKind::skeleton},
                                                      {"refine", TierKind::refine}}};
constexpr std::array<Word<SolverKind>, 3> solverWords = {
    {{"euler", SolverKind::euler}, {"midpoint", SolverKind::midpoint}, {"heun", SolverKind::heun}}};
constexpr std::array<Word<TierRepresentation>, 2> representationWords = {
    {{"raw", TierRepresentation::raw}, {"latent", TierRepresentation::latent}}};

template <typename Value, std::size_t Count>
Value readWord(const HeaderNode& node, const std::array<Word<Value>, Count>& words) {
    const std::string found = node.text(nameBytes);
    std::string expectation = "one of";
    for (const auto& [word, value] : words) {
        if (found == word) {
            return value;
        }
        expectation += " \"" + std::string(word) + '"';
    }
    node.refuse(expectation);
}

template <typename Value, std::size_t Count>
std::string_view findWord(const std::array<Word<Value>, Count>& words, Value wanted) noexcept {
    for (const auto& [word, value] : words) {
        if (value == wanted) {
            return word;
        }
    }
    return "unknown";
}

std::string readGraphName(const HeaderNode& node, const NameIndex& blobNames, const std::vector<Blob>& blobs) {
    const Blob& blob = blobs[blobNames.at(node, "blob")];
    if (blob.type != BlobType::onnx) {
        node.refuse("the name of a blob of type \"onnx\"");
    }
    return blob.name;
}

std::vector<std::int64_t> readLatentShape(const HeaderNode& node) {
    std::vector<std::int64_t> shape;
    std::int64_t product = 1;
    for (const HeaderNode& dimension : node.elements(1, 3)) {
        shape.push_back(dimension.integer(1, 4096));
        product *= shape.back();
    }
    if (product > 65'536) {
        node.refuse("a latent of at most 65536 numbers");
    }
    return shape;
}

/// The figure of this name, if it is a possible error in dB.
std::optional<double> errorOf(const nlohmann::json& accuracy, const char* figure) {
    const auto found = accuracy.find(figure);
    if (found == accuracy.end() || !found->is_number()) {
        return std::nullopt;
    }
    const double value = found->get<double>();
    return std::isfinite(value) && value >= 0.0 ? std::optional(value) : std::nullopt;
}

std::optional<double> readError(const std::string& accuracyJson) {
    const nlohmann::json accuracy = nlohmann::json::parse(accuracyJson);
    const auto spectral = errorOf(accuracy, "lsd_db");
    const auto level = errorOf(accuracy, "level_error_p90_db");
    return spectral && level ? std::optional(*spectral + *level) : std::nullopt;
}

/// The keys of tiers that are networks alone.
void readSolvedKeys(const HeaderNode& node, const NameIndex& blobNames, const std::vector<Blob>& blobs, Tier& tier) {
    tier.level = readGraphName(node.at("level"), blobNames, blobs);
    tier.solver = readWord(node.at("solver"), solverWords);
    tier.steps = static_cast<int>(node.at("steps").integer(1, 16));
    tier.representation = readWord(node.at("representation"), representationWords);
    if (tier.representation == TierRepresentation::latent) {
        tier.latentShape = readLatentShape(node.at("latent_shape"));
        tier.encoder = readGraphName(node.at("encoder"), blobNames, blobs);
        tier.decoder = readGraphName(node.at("decoder"), blobNames, blobs);
    }
}

}  // namespace

std::vector<std::size_t> tiersByAccuracy(const std::vector<Tier>& tiers) {
    std::vector<std::size_t> order(tiers.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (std::ranges::all_of(tiers, [](const Tier& tier) { return tier.errorDb.has_value(); })) {
        std::ranges::sort(order, [&tiers](std::size_t first, std::size_t second) {
            const double firstErrorDb = *tiers[first].errorDb;
            const double secondErrorDb = *tiers[second].errorDb;
            return firstErrorDb > secondErrorDb || (firstErrorDb == secondErrorDb && first < second);
        });
    }
    return order;
}

Tier readTier(const HeaderNode& node, const NameIndex& blobNames, const std::vector<Blob>& blobs) {
    Tier tier;
    tier.name = node.at("name").name(nameBytes);
    tier.kind = readWord(node.at("kind"), kindWords);
    if (tier.kind != TierKind::skeleton) {
        tier.field = readGraphName(node.at("field"), blobNames, blobs);
    }
    if (!tier.usesSkeleton()) {
        readSolvedKeys(node, blobNames, blobs, tier);
    }
    tier.parameters = node.at("parameters").integer(0, maximumParameters);
    tier.accuracyJson = node.at("accuracy").objectText();
    tier.costJson = node.at("cost").objectText();
    tier.errorDb = readError(tier.accuracyJson);
    return tier;
}

SkeletonHeader readSkeleton(const HeaderNode& node) {
    const auto requireSize = [&node](std::string_view key, std::size_t size) {
        (void)node.at(key).integer(static_cast<std::int64_t>(size), static_cast<std::int64_t>(size));
    };
    requireSize("order", SkeletonHeader::order);
    requireSize("harmonics", SkeletonHeader::harmonics);
    requireSize("swing_harmonics", SkeletonHeader::swingHarmonics);
    const HeaderNode thresholds = node.at("rungs");
    if (!std::ranges::equal(thresholds.numbers(SkeletonHeader::impulseThresholds.size(), 0.0, 16.0),
                            SkeletonHeader::impulseThresholds)) {
        thresholds.refuse("[2, 2.6, 3.1, 3.5, 4]");
    }
    return {.hidden = node.at("hidden").integer(1, 512),
            .parameters = node.at("parameters").integer(0, maximumParameters)};
}

std::string_view kindName(TierKind kind) noexcept {
    return findWord(kindWords, kind);
}

std::string_view solverName(SolverKind solver) noexcept {
    return findWord(solverWords, solver);
}

}  // namespace haptoflow::model
