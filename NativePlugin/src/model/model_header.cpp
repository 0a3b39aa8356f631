#include "model/model_header.hpp"

#include "model/file_layout.hpp"
#include "model/header_node.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace haptoflow::model {
namespace {

/// Maps names to indices; refuses duplicate names.
class NameIndex {
public:
    void add(const HeaderNode& node, const std::string& name, std::size_t position) {
        if (!positions_.emplace(name, position).second) {
            node.refuse("a name that no other element has; \"" + name + "\" appears twice");
        }
    }
    [[nodiscard]] std::size_t at(const HeaderNode& node, const std::string& what) const {
        const std::string name = node.name(nameBytes);
        const auto found = positions_.find(name);
        if (found == positions_.end()) {
            node.refuse("the name of a " + what + "; there is no \"" + name + '"');
        }
        return found->second;
    }

private:
    std::unordered_map<std::string, std::size_t> positions_;
};

constexpr auto maximumLength = static_cast<std::int64_t>(maximumFileBytes);

std::vector<std::int64_t> readShape(const HeaderNode& node) {
    std::vector<std::int64_t> shape;
    std::int64_t product = 1;
    for (const HeaderNode& dimension : node.elements(1, maximumTensorRank)) {
        shape.push_back(dimension.integer(1, maximumLength / 4));
        // Cannot overflow: both factors are below 2^28, and the product is compared after each.
        product *= shape.back();
        if (product > maximumLength / 4) {
            node.refuse("a tensor that fits into a file of 268435456 bytes");
        }
    }
    return shape;
}

Blob readBlob(const HeaderNode& node) {
    Blob blob;
    blob.name = node.at("name").name(nameBytes);
    const HeaderNode type = node.at("type");
    const std::string word = type.text(nameBytes);
    blob.bytes = static_cast<std::size_t>(node.at("bytes").integer(1, maximumLength));
    const HeaderNode offset = node.at("offset");
    blob.offset = static_cast<std::size_t>(offset.integer(0, maximumLength));
    if (blob.offset % blobAlignment != 0) {
        offset.refuse("a multiple of 64");
    }
    blob.crc32 = static_cast<std::uint32_t>(node.at("crc32").integer(0, 0xFFFFFFFF));
    if (word == "onnx") {
        blob.type = BlobType::onnx;
        const HeaderNode shape = node.at("shape");
        if (!shape.elements(0, maximumTensorRank).empty()) {
            shape.refuse("[], because the blob is a graph");
        }
        return blob;
    }
    if (word != "float32") {
        type.refuse(R"("float32" or "onnx")");
    }
    blob.type = BlobType::float32;
    blob.shape = readShape(node.at("shape"));
    std::size_t count = 1;
    for (const std::int64_t dimension : blob.shape) {
        count *= static_cast<std::size_t>(dimension);
    }
    if (blob.bytes != count * sizeof(float)) {
        node.at("bytes").refuse("4 times the product of the shape (" + std::to_string(count * sizeof(float)) + ')');
    }
    return blob;
}

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

Provenance readProvenance(const HeaderNode& node) {
    Provenance provenance;
    provenance.statement = node.at("statement").name(maximumTextBytes);
    provenance.recordings = node.at("recordings").text(maximumTextBytes);
    provenance.licence = node.at("licence").text(maximumTextBytes);
    provenance.seed = node.at("seed").integer(INT64_MIN, INT64_MAX);
    provenance.commit = node.at("commit").text(nameBytes);
    (void)node.at("configuration");
    provenance.created = node.at("created").date();
    return provenance;
}

TrainedInterval readInterval(const HeaderNode& bounds, const HeaderNode& percentiles, double limit) {
    TrainedInterval interval;
    const auto edges = bounds.numbers(2, 0.0, limit);
    if (edges[0] >= edges[1]) {
        bounds.refuse("[min, max] with min below max");
    }
    interval.minimum = edges[0];
    interval.maximum = edges[1];
    const auto values = percentiles.numbers(interval.percentiles.size(), 0.0, limit);
    if (!std::is_sorted(values.begin(), values.end())) {
        percentiles.refuse("five numbers in rising order");
    }
    std::copy(values.begin(), values.end(), interval.percentiles.begin());
    return interval;
}

SeedEntry readSeed(const HeaderNode& node, const NameIndex& labelNames) {
    SeedEntry seed;
    seed.label = labelNames.at(node.at("label"), "label");
    const auto velocity = node.at("velocity_mps").numbers(2, -maximumSpeedMps, maximumSpeedMps);
    seed.velocityMps = {velocity[0], velocity[1]};
    seed.forceNewtons = node.at("force_newtons").number(0.0, maximumForceNewtons);
    if (const auto phase = node.find("rib_phase")) {
        const auto cycles = phase->numbers(seed.ribPhase.size(), 0.0, 1.0);
        std::ranges::copy(cycles, seed.ribPhase.begin());
    }
    if (const auto gain = node.find("gain")) {
        seed.gain = static_cast<float>(gain->number(0.0, maximumSeedGain));
    }
    return seed;
}

void checkFixedValues(const HeaderNode& root) {
    (void)root.at("sample_rate_hz").number(dsp::waveformRateHz, dsp::waveformRateHz);
    (void)root.at("segment_samples").integer(dsp::segmentSamples, dsp::segmentSamples);
    (void)root.at("embedding_size").integer(embeddingSize, embeddingSize);
    const HeaderNode unit = root.at("normalisation").at("unit");
    if (unit.text(nameBytes) != "m/s^2") {
        unit.refuse("\"m/s^2\"");
    }
}

/// The blob named `name`, which must be a float32 matrix with `columns` columns.
const Blob& requireMatrix(const HeaderNode& node, const std::string& name, const std::vector<Blob>& blobs,
                          std::size_t columns) {
    const auto blob = std::find_if(blobs.begin(), blobs.end(), [&](const Blob& each) { return each.name == name; });
    if (blob == blobs.end() || blob->type != BlobType::float32 || blob->shape.size() != 2 ||
        blob->shape[1] != static_cast<std::int64_t>(columns)) {
        node.refuse("a blob \"" + name + R"(" of type "float32" and shape [rows, )" + std::to_string(columns) + ']');
    }
    return *blob;
}

void readSeedBank(const HeaderNode& bank, const NameIndex& labelNames, ModelHeader& header) {
    (void)bank.at("samples").integer(seedSamples, seedSamples);
    header.seedTensor = bank.at("tensor").name(nameBytes);
    const Blob& seeds = requireMatrix(bank.at("tensor"), header.seedTensor, header.blobs, seedSamples);
    for (const HeaderNode& node : bank.at("entries").elements(1, maximumSeeds)) {
        header.seeds.push_back(readSeed(node, labelNames));
    }
    if (seeds.shape[0] != static_cast<std::int64_t>(header.seeds.size())) {
        bank.at("entries").refuse("as many entries as the seed tensor has rows (" + std::to_string(seeds.shape[0]) +
                                  ')');
    }
}

/// Reads what touches begin with: a skeleton or a seed bank, of which a file has one.
void readBeginnings(const HeaderNode& root, const NameIndex& labelNames, ModelHeader& header) {
    const auto skeleton = root.find("skeleton");
    const auto bank = root.find("seed_bank");
    if (!skeleton && std::ranges::any_of(header.tiers, &Tier::usesSkeleton)) {
        root.refuse(R"(a member "skeleton", which tiers of kind "skeleton" and "refine" need: export the model again)");
    }
    if (skeleton && bank) {
        bank->refuse("no seed bank beside a skeleton: export the model again");
    }
    if (skeleton) {
        header.skeleton = readSkeleton(*skeleton);
        (void)requireMatrix(root.at("blobs"), std::string(skeletonTensor), header.blobs,
                            static_cast<std::size_t>(header.skeleton->hidden));
    } else if (bank) {
        readSeedBank(*bank, labelNames, header);
    } else {
        root.refuse(R"(a member "seed_bank" or "skeleton", from which touches begin: export the model again)");
    }
}

/// The blob "pieces" may be missing.
void checkPieces(const HeaderNode& node, const std::vector<Blob>& blobs, std::int64_t rows) {
    const auto blob = std::ranges::find(blobs, piecesTensor, &Blob::name);
    if (blob == blobs.end()) {
        return;
    }
    const std::vector<std::int64_t>& shape = blob->shape;
    const auto isWithin = [](std::int64_t count) { return count <= static_cast<std::int64_t>(maximumPieces); };
    if (shape.size() != 3 || shape[0] != rows || !isWithin(shape[1]) ||
        shape[2] != static_cast<std::int64_t>(textureSize)) {
        node.refuse("a blob \"" + std::string(piecesTensor) + R"(" of type "float32" and shape [)" +
                    std::to_string(rows) + ", 1 to " + std::to_string(maximumPieces) + ", " +
                    std::to_string(textureSize) + "], or none");
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

bool isUnitRms(std::span<const float> samples) {
    return std::fabs(rmsOf(samples) - 1.0) <= 0.01;
}

double rmsOf(std::span<const float> samples) {
    double sumOfSquares = 0.0;
    for (const float value : samples) {
        sumOfSquares += static_cast<double>(value) * static_cast<double>(value);
    }
    return std::sqrt(sumOfSquares / static_cast<double>(samples.size()));
}

std::string spaceOf(const ModelHeader& header) {
    std::string text;
    for (const Tier& tier : header.tiers) {
        const std::string_view identity = tier.kind == TierKind::skeleton ? skeletonTensor : tier.field;
        const auto blob = std::ranges::find(header.blobs, identity, &Blob::name);
        text += tier.name + ':' + hexadecimal(blob->crc32) + ';';
    }
    return hexadecimal(crc32(std::as_bytes(std::span(text))));
}

ModelHeader readHeader(std::string_view text) {
    const nlohmann::json json = parseBoundedJson(text);
    const HeaderNode root(json, "");
    checkFixedValues(root);

    ModelHeader header;
    header.name = root.at("name").name(nameBytes);
    header.description = root.at("description").text(maximumTextBytes);
    header.provenance = readProvenance(root.at("provenance"));
    header.peakMps2 = root.at("normalisation").at("peak_mps2").number(1e-9, 1e6);
    const HeaderNode range = root.at("range");
    header.speedMps = readInterval(range.at("speed_mps"), range.at("speed_percentiles_mps"), maximumSpeedMps);
    header.forceNewtons =
        readInterval(range.at("force_newtons"), range.at("force_percentiles_newtons"), maximumForceNewtons);

    NameIndex blobNames;
    for (const HeaderNode& node : root.at("blobs").elements(1, maximumBlobs)) {
        header.blobs.push_back(readBlob(node));
        blobNames.add(node, header.blobs.back().name, header.blobs.size() - 1);
    }
    const Blob& embedding = requireMatrix(root.at("blobs"), "embedding", header.blobs, embeddingSize);
    checkPieces(root.at("blobs"), header.blobs, embedding.shape[0]);

    NameIndex labelNames;
    for (const HeaderNode& node : root.at("labels").elements(1, maximumLabels)) {
        header.labels.push_back(readLabel(node, static_cast<std::size_t>(embedding.shape[0])));
        labelNames.add(node, header.labels.back().name, header.labels.size() - 1);
    }

    NameIndex tierNames;
    for (const HeaderNode& node : root.at("tiers").elements(1, maximumTiers)) {
        header.tiers.push_back(readTier(node, blobNames, header.blobs));
        tierNames.add(node, header.tiers.back().name, header.tiers.size() - 1);
    }
    header.defaultTier = tierNames.at(root.at("default_tier"), "tier");

    readBeginnings(root, labelNames, header);
    if (const auto measurements = root.find("measurements")) {
        (void)measurements->objectText();
    }
    return header;
}

std::string_view kindName(TierKind kind) noexcept {
    return findWord(kindWords, kind);
}

std::string_view solverName(SolverKind solver) noexcept {
    return findWord(solverWords, solver);
}

}  // namespace haptoflow::model
