#include "commands.hpp"
#include "headless/command_files.hpp"
#include "messages.hpp"
#include "model/material_file.hpp"
#include "model/plain_text.hpp"
#include "option_values.hpp"
#include "render_output.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <iostream>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::cli {
namespace {

using model::hexadecimal;
using model::shortNumber;
using Row = std::vector<std::string>;

struct InspectOptions {
    std::string modelPath;
    std::string picturePath;
    bool json = false;
};

/// A text of the file, for the terminal.
std::string orDash(const std::string& text) {
    return text.empty() ? "-" : model::printable(text);
}

/// Left-aligned columns, two spaces apart; the first row is the heading.
void printTable(std::ostream& stream, const std::vector<Row>& rows) {
    std::vector<std::size_t> widths(rows.front().size());
    for (const Row& row : rows) {
        for (std::size_t column = 0; column < row.size(); ++column) {
            widths[column] = std::max(widths[column], row[column].size());
        }
    }
    for (const Row& row : rows) {
        std::string line = "  ";
        for (std::size_t column = 0; column < row.size(); ++column) {
            line += row[column];
            if (column + 1 < row.size()) {
                line += std::string(widths[column] - row[column].size() + 2, ' ');
            }
        }
        stream << line << '\n';
    }
}

/// Measured figures on one line: "key value, key value".
std::string figures(const std::string& json) {
    std::string text;
    const nlohmann::json measured = nlohmann::json::parse(json);
    for (const auto& [key, value] : measured.items()) {
        const std::string figure = value.is_number() ? shortNumber(value.get<double>()) : value.dump();
        text += (text.empty() ? "" : ", ") + key + ' ' + figure;
    }
    return text.empty() ? "not measured" : text;
}

std::string skeletonOf(const model::ModelHeader& header) {
    return header.skeleton ? std::to_string(header.skeleton->parameters) + " weights, " +
                                 std::to_string(header.skeleton->hidden) + " hidden units"
                           : "-";
}

void printGeneral(std::ostream& stream, const std::string& path, const model::ModelFile& file) {
    const model::ModelHeader& header = file.header();
    const model::Provenance& provenance = header.provenance;
    const auto interval = [](const model::TrainedInterval& range) {
        return shortNumber(range.minimum) + " to " + shortNumber(range.maximum);
    };
    stream << model::printable(header.name) << '\n' << orDash(header.description) << "\n\n";
    printTable(stream, {{"file", model::printable(path)},
                        {"size", std::to_string(file.byteCount()) + " bytes, CRC-32 " + hexadecimal(file.checksum()) +
                                     ", all checksums verified"},
                        {"provenance", orDash(provenance.statement)},
                        {"recordings", orDash(provenance.recordings)},
                        {"licence", orDash(provenance.licence)},
                        {"created", orDash(provenance.created)},
                        {"commit", orDash(provenance.commit) + ", seed " + std::to_string(provenance.seed)},
                        {"trained speed", interval(header.speedMps) + " m/s"},
                        {"trained force", interval(header.forceNewtons) + " N"},
                        {"peak", shortNumber(header.peakMps2) + " m/s^2"},
                        {"seeds", header.seeds.empty() ? "-" : std::to_string(header.seeds.size())},
                        {"skeleton", skeletonOf(header)},
                        {"space", model::spaceOf(header) + ": material files of this space work with the model"}});
}

std::string wanderOf(const model::Label& label) {
    std::string text;
    for (const model::RibWander& each : label.ribWander) {
        text += (text.empty() ? "" : ", ") + shortNumber(each.cycles);
    }
    return text.empty() ? "-" : text;
}

void printLabels(std::ostream& stream, const model::ModelHeader& header) {
    std::vector<Row> rows{{"label", "category", "level exponents (speed, force)", "frequency exponent", "wavelength mm",
                           "stiffness N/m", "friction", "stick-slip mm", "rib wander turns"}};
    for (const model::Label& label : header.labels) {
        rows.push_back({orDash(label.name), orDash(label.category),
                        shortNumber(label.speedLevelExponent) + ", " + shortNumber(label.forceLevelExponent),
                        shortNumber(label.frequencyExponent),
                        label.wavelengthMetres ? shortNumber(*label.wavelengthMetres * 1000.0) : "-",
                        shortNumber(label.stiffnessNewtonsPerMetre), shortNumber(label.frictionCoefficient),
                        label.stickSlip ? shortNumber(label.stickSlip->lengthMetres * 1000.0) : "-", wanderOf(label)});
    }
    stream << "\nLabels (" << header.labels.size() << ")\n";
    printTable(stream, rows);
}

void printTiers(std::ostream& stream, const model::ModelFile& file) {
    const model::ModelHeader& header = file.header();
    std::vector<Row> rows{{"tier", "kind", "solver", "steps", "parameters", "graph bytes", "accuracy", "cost"}};
    for (std::size_t index = 0; index < header.tiers.size(); ++index) {
        const model::Tier& tier = header.tiers[index];
        rows.push_back({orDash(tier.name) + (index == header.defaultTier ? " (default)" : ""),
                        std::string(model::kindName(tier.kind)),
                        tier.isSolved() ? std::string(model::solverName(tier.solver)) : "-",
                        tier.isSolved() ? std::to_string(tier.steps) : "-", std::to_string(tier.parameters),
                        tier.needsOnnxRuntime() ? std::to_string(file.blob(tier.field).size()) : "-",
                        figures(tier.accuracyJson), figures(tier.costJson)});
    }
    stream << "\nTiers (" << header.tiers.size() << ")\n";
    printTable(stream, rows);
}

void printJson(std::ostream& stream, const std::string& path, const model::ModelFile& file) {
    const nlohmann::json report = {{"file",
                                    {{"path", path},
                                     {"bytes", file.byteCount()},
                                     {"crc32", hexadecimal(file.checksum())},
                                     {"checksums_verified", true}}},
                                   {"header", nlohmann::json::parse(file.headerText())}};
    stream << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
}

std::string between(const std::array<double, 2>& range) {
    return shortNumber(range[0]) + " to " + shortNumber(range[1]);
}

/// A material's wave vectors as text, in cycles per millimetre.
std::string ribsOf(const model::MaterialFile& material) {
    std::string text;
    const auto vectors = std::span(material.embedding).last(4);
    for (std::size_t first = 0; first < vectors.size(); first += 2) {
        if (vectors[first] != 0.0F || vectors[first + 1] != 0.0F) {
            text += (text.empty() ? "" : "; ") + shortNumber(vectors[first]) + ", " + shortNumber(vectors[first + 1]);
        }
    }
    return text.empty() ? "none" : text + " cycles/mm along the two axes";
}

std::string levelOf(const model::Label& label) {
    const std::string offset =
        label.levelOffsetDb != 0.0 ? ", " + shortNumber(label.levelOffsetDb) + " dB added" : std::string();
    if (!label.level) {
        return "the model's" + offset;
    }
    return "its own, at " + std::to_string(label.level->speedsMps.size()) + " speeds from " +
           shortNumber(label.level->speedsMps.front()) + " to " + shortNumber(label.level->speedsMps.back()) + " m/s" +
           offset;
}

std::string toneOf(const model::Label& label) {
    return label.tone ? std::to_string(label.tone->frequenciesHz.size()) + " frequencies at " +
                            std::to_string(label.tone->speedsMps.size()) + " speeds"
                      : "none";
}

void printMaterial(std::ostream& stream, const std::string& path, const model::MaterialFile& material) {
    const model::Label& label = material.label;
    const model::MaterialProvenance& provenance = material.provenance;
    stream << model::printable(label.name) << '\n' << orDash(material.description) << "\n\n";
    printTable(stream,
               {{"file", model::printable(path)},
                {"space", material.space + ": works with the models of this space"},
                {"category", orDash(label.category)},
                {"provenance", orDash(provenance.statement)},
                {"recordings", orDash(provenance.recordings)},
                {"licence", orDash(provenance.licence)},
                {"learnt from", shortNumber(provenance.seconds) + " s"},
                {"created", orDash(provenance.created)},
                {"speed", between(material.speedMps) + " m/s"},
                {"force", between(material.forceNewtons) + " N"},
                {"level", levelOf(label)},
                {"tone", toneOf(label)},
                {"wave vectors", ribsOf(material)},
                {"wavelength", label.wavelengthMetres ? shortNumber(*label.wavelengthMetres * 1000.0) + " mm" : "-"},
                {"stiffness", shortNumber(label.stiffnessNewtonsPerMetre) + " N/m"},
                {"friction", shortNumber(label.frictionCoefficient)},
                {"seeds", material.seeds.empty() ? "-" : std::to_string(material.seeds.size())}});
}

void inspectMaterial(const InspectOptions& options) {
    const std::string text = headless::readInputFile("the material", options.modelPath, "a material file");
    try {
        const model::MaterialFile material = model::parseMaterial(text);
        if (options.json) {
            const nlohmann::json report = {{"file", {{"path", options.modelPath}, {"bytes", text.size()}}},
                                           {"material", nlohmann::json::parse(text)}};
            std::cout << report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << '\n';
            return;
        }
        printMaterial(std::cout, options.modelPath, material);
    } catch (const model::MaterialError& error) {
        throw InputError(options.modelPath + ": " + error.what());
    }
}

void runInspect(const InspectOptions& options) {
    if (clipFormatOf(options.modelPath)) {
        inspectClip(options.modelPath, options.json, options.picturePath);
        return;
    }
    if (!options.picturePath.empty()) {
        throw UsageError("--picture draws clips; " + options.modelPath + " is none (.haptic, .ahap, .hjif)");
    }
    if (options.modelPath.ends_with(".haptomaterial")) {
        inspectMaterial(options);
        return;
    }
    // Reading verifies every checksum.
    const model::ModelFile file = readModel(options.modelPath);
    if (options.json) {
        printJson(std::cout, options.modelPath, file);
        return;
    }
    printGeneral(std::cout, options.modelPath, file);
    printLabels(std::cout, file.header());
    printTiers(std::cout, file);
}

}  // namespace

void addInspectCommand(CLI::App& app) {
    CLI::App* command = app.add_subcommand("inspect", "Verify a model, a material or a clip and show its content");
    const auto options = std::make_shared<InspectOptions>();
    command->add_option("model", options->modelPath, "The .haptoflow, .haptomaterial, .haptic, .ahap or .hjif file")
        ->required()
        ->type_name("FILE");
    command->add_flag("--json", options->json,
                      "Print the file's header, size and checksum, or a clip's figures, as JSON");
    command->add_option("--picture", options->picturePath, "Draw a clip's amplitude and frequency over time")
        ->type_name("OUT.svg");
    command->footer(
        "Examples:\n"
        "  haptoflow inspect default.haptoflow --json\n"
        "  haptoflow inspect click.haptic --picture click.svg");
    command->callback([options] { runInspect(*options); });
}

}  // namespace haptoflow::cli
