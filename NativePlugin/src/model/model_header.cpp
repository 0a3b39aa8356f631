#include "model/model_header.hpp"

#include "model/file_layout.hpp"
#include "model/header_node.hpp"
#include "model/model_blobs.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace haptoflow::model {
namespace {

Provenance readProvenance(const HeaderNode& node) {
    Provenance provenance;
    provenance.statement = node.at("statement").name(maximumTextBytes);
    provenance.recordings = node.at("recordings").text(maximumTextBytes);
    provenance.licence = node.at("licence").text(maximumTextBytes);
    provenance.seed = node.at("seed").integer(INT64_MIN, INT64_MAX);
    provenance.commit = node.at("commit").text(nameBytes);
    provenance.configurationJson = node.at("configuration").anyText();
    const HeaderNode created = node.at("created");
    provenance.created = created.text(nameBytes);
    if (!provenance.created.empty() && !isCalendarDate(provenance.created)) {
        created.refuse("a date as YYYY-MM-DD, or an empty string");
    }
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
        node.refuse("a blob \"" + name + "\" of type \"float32\" and shape [rows, " + std::to_string(columns) + ']');
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
        root.refuse(
            "a member \"skeleton\", which tiers of kind \"skeleton\" and \"refine\" need: export the model again");
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
        root.refuse("a member \"seed_bank\" or \"skeleton\", from which touches begin: export the model again");
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
        node.refuse("a blob \"" + std::string(piecesTensor) + "\" of type \"float32\" and shape [" +
                    std::to_string(rows) + ", 1 to " + std::to_string(maximumPieces) + ", " +
                    std::to_string(textureSize) + "], or none");
    }
}

}  // namespace

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

}  // namespace haptoflow::model
