#include "model/material_file.hpp"

#include "model/file_layout.hpp"
#include "model/header_node.hpp"
#include "model/model_error.hpp"

#include <algorithm>
#include <cstdint>

namespace haptoflow::model {
namespace {

constexpr std::size_t spaceDigits = 8;
constexpr std::int64_t newestVersion = 1;

void checkFormat(const HeaderNode& root) {
    const HeaderNode format = root.at("format");
    if (format.text(nameBytes) != "haptoflow-material") {
        format.refuse("\"haptoflow-material\"");
    }
    const HeaderNode version = root.at("version");
    if (version.integer(1, INT64_MAX) > newestVersion) {
        version.refuse("version 1; update HaptoFlow to read a newer one");
    }
}

std::string readSpace(const HeaderNode& node) {
    std::string space = node.text(nameBytes);
    const auto isDigit = [](char each) { return (each >= '0' && each <= '9') || (each >= 'a' && each <= 'f'); };
    if (space.size() != spaceDigits || !std::ranges::all_of(space, isDigit)) {
        node.refuse("8 hexadecimal digits in lower case");
    }
    return space;
}

MaterialProvenance readProvenance(const HeaderNode& node) {
    MaterialProvenance provenance;
    provenance.statement = node.at("statement").text(maximumTextBytes);
    provenance.recordings = node.at("recordings").text(maximumTextBytes);
    provenance.licence = node.at("licence").name(maximumTextBytes);
    provenance.seconds = node.at("seconds").number(0.0, 1e9);
    provenance.created = node.at("created").date();
    return provenance;
}

std::array<double, 2> readRange(const HeaderNode& node, double limit) {
    const auto edges = node.numbers(2, 0.0, limit);
    if (edges[0] > edges[1]) {
        node.refuse("[lowest, highest]");
    }
    return {edges[0], edges[1]};
}

MaterialSeed readSeed(const HeaderNode& node) {
    MaterialSeed seed;
    const auto velocity = node.at("velocity_mps").numbers(2, -maximumSpeedMps, maximumSpeedMps);
    std::ranges::copy(velocity, seed.velocityMps.begin());
    seed.forceNewtons = node.at("force_newtons").number(0.0, maximumForceNewtons);
    if (const auto phase = node.find("rib_phase")) {
        std::ranges::copy(phase->numbers(seed.ribPhase.size(), 0.0, 1.0), seed.ribPhase.begin());
    }
    const HeaderNode samples = node.at("samples");
    std::ranges::transform(samples.numbers(seedSamples, -maximumMagnitude, maximumMagnitude), seed.samples.begin(),
                           [](double sample) { return static_cast<float>(sample); });
    if (!isUnitRms(seed.samples)) {
        samples.refuse("an RMS of 1 within 1 %");
    }
    return seed;
}

MaterialFile readRoot(const HeaderNode& root) {
    checkFormat(root);
    MaterialFile material;
    material.space = readSpace(root.at("space"));
    const HeaderNode name = root.at("name");
    material.label.name = name.name(nameBytes);
    if (material.label.name.find_first_not_of(' ') == std::string::npos) {
        name.refuse("text that is not blank");
    }
    if (const auto description = root.find("description")) {
        material.description = description->text(maximumTextBytes);
    }
    material.provenance = readProvenance(root.at("provenance"));
    std::ranges::transform(root.at("embedding").numbers(embeddingSize, -maximumMagnitude, maximumMagnitude),
                           material.embedding.begin(), [](double value) { return static_cast<float>(value); });
    material.speedMps = readRange(root.at("range").at("speed_mps"), maximumSpeedMps);
    material.forceNewtons = readRange(root.at("range").at("force_newtons"), maximumForceNewtons);
    readLabelTraits(root, material.label);
    if (const auto seeds = root.find("seeds")) {
        for (const HeaderNode& node : seeds->elements(0, maximumMaterialSeeds)) {
            material.seeds.push_back(readSeed(node));
        }
    }
    return material;
}

}  // namespace

MaterialFile parseMaterial(std::string_view json) {
    if (json.size() > maximumMaterialBytes) {
        throw MaterialError("the material has " + std::to_string(json.size()) + " bytes; the limit is " +
                            std::to_string(maximumMaterialBytes));
    }
    try {
        const nlohmann::json value = parseBoundedJson(json, "the material");
        return readRoot(HeaderNode(value, "", "material"));
    } catch (const ModelError& error) {
        throw MaterialError(error.what());
    }
}

MaterialFile readMaterial(const std::filesystem::path& path) {
    try {
        const std::vector<std::byte> bytes = readFile(path, maximumMaterialBytes);
        return parseMaterial({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    } catch (const std::runtime_error& error) {
        const std::u8string name = path.u8string();
        throw MaterialError(std::string(name.begin(), name.end()) + ": " + error.what());
    }
}

void requireSpace(const MaterialFile& material, const ModelHeader& header) {
    const std::string space = spaceOf(header);
    if (material.space != space) {
        throw MaterialMismatch("material \"" + material.label.name + "\" was learnt for the space " + material.space +
                               "; the model \"" + header.name + "\" has the space " + space +
                               ": learn the material again with this model");
    }
}

}  // namespace haptoflow::model
