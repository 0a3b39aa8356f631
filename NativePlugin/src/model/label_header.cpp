#include "model/header_node.hpp"

#include <algorithm>
#include <string>

namespace haptoflow::model {

namespace {

Impact readImpact(const HeaderNode& node) {
    Impact impact;
    const std::vector<HeaderNode> modes = node.at("modes").elements(1, Impact::maximumModes);
    for (std::size_t i = 0; i < modes.size(); ++i) {
        impact.modes[i] = {.frequencyHz = modes[i].at("frequency_hz").number(1.0, 1000.0),
                           .decayPerSecond = modes[i].at("decay_per_second").number(10.0, 10000.0),
                           .gainPerSecond = modes[i].at("gain_per_second").number(0.0, 10000.0)};
    }
    impact.restitution = node.at("restitution").number(0.0, 0.9);
    return impact;
}

LevelTable readLevel(const HeaderNode& node) {
    LevelTable level;
    level.speedsMps = node.at("speeds_mps").risingNumbers(1, LevelTable::maximumSpeeds, 0.0, maximumSpeedMps);
    level.logLevels = node.at("log_levels").numbers(level.speedsMps.size(), -20.0, 20.0);
    level.forceNewtons = node.at("force_newtons").number(0.01, 100.0);
    level.forceExponent = node.at("force_exponent").number(-maximumLevelExponent, maximumLevelExponent);
    return level;
}

ToneTable readTone(const HeaderNode& node) {
    ToneTable tone;
    // Above 0, because the rows are interpolated over the logarithm of speed.
    tone.speedsMps = node.at("speeds_mps").risingNumbers(1, ToneTable::maximumSpeeds, 1e-6, maximumSpeedMps);
    tone.frequenciesHz = node.at("frequencies_hz")
                             .risingNumbers(ToneTable::minimumFrequencies, ToneTable::maximumFrequencies, 10.0, 1000.0);
    if (const auto forces = node.find("forces_newtons")) {
        tone.forcesNewtons = forces->risingNumbers(1, ToneTable::maximumForces, 1e-6, 1e3);
    }
    const HeaderNode gains = node.at("gains_db");
    const std::size_t rows = tone.speedsMps.size() * tone.forcesNewtons.size();
    for (const HeaderNode& row : gains.elements(0, ToneTable::maximumSpeeds * ToneTable::maximumForces)) {
        tone.gainsDb.push_back(row.numbers(tone.frequenciesHz.size(), -30.0, 30.0));
    }
    if (tone.gainsDb.size() != rows) {
        gains.refuse("one row for each of the " + std::to_string(tone.speedsMps.size()) + " speeds" +
                     (tone.forcesNewtons.size() > 1
                          ? " at each of the " + std::to_string(tone.forcesNewtons.size()) + " forces"
                          : ""));
    }
    return tone;
}

StickSlip readStickSlip(const HeaderNode& node) {
    return {.lengthMetres = node.at("length_metres").number(1e-6, 1.0),
            .wander = node.at("wander").number(0.0, 1.0),
            .wanderMetres = node.at("wander_metres").number(1e-6, 10.0)};
}

std::vector<RibWander> readRibWander(const HeaderNode& node) {
    std::vector<RibWander> wanders;
    for (const HeaderNode& each : node.elements(1, 2)) {
        wanders.push_back({.cycles = each.at("turns").number(0.0, 10.0),
                           .wavelengthMetres = each.at("wavelength_metres").number(1e-6, 10.0)});
    }
    return wanders;
}

}  // namespace

void readLabelTraits(const HeaderNode& node, Label& label) {
    label.speedLevelExponent =
        node.at("level_exponents").at("speed").number(-maximumLevelExponent, maximumLevelExponent);
    label.forceLevelExponent =
        node.at("level_exponents").at("force").number(-maximumLevelExponent, maximumLevelExponent);
    label.frequencyExponent = node.at("frequency_exponent").number(0.0, 4.0);
    const HeaderNode wavelength = node.at("wavelength_metres");
    if (node.at("periodic").boolean()) {
        if (wavelength.isNull()) {
            wavelength.refuse("a number from 1e-06 to 1, because \"periodic\" is true");
        }
        label.wavelengthMetres = wavelength.number(1e-6, 1.0);
    } else if (!wavelength.isNull()) {
        wavelength.refuse("null, because the label is not periodic");
    }
    label.stiffnessNewtonsPerMetre = node.at("stiffness_newtons_per_metre").number(1e-3, 1e6);
    label.frictionCoefficient = node.at("friction_coefficient").number(0.0, 10.0);
    if (const auto impact = node.find("impact")) {
        label.impact = readImpact(*impact);
    }
    label.category = node.at("category").name(nameBytes);
    if (const auto level = node.find("level")) {
        label.level = readLevel(*level);
    }
    if (const auto tone = node.find("tone")) {
        label.tone = readTone(*tone);
    }
    if (const auto gain = node.find("impulse_gain")) {
        label.impulseGain = static_cast<float>(gain->number(0.0, 8.0));
    }
    if (const auto offset = node.find("level_offset_db")) {
        label.levelOffsetDb = offset->number(-24.0, 24.0);
    }
    if (const auto stickSlip = node.find("stick_slip")) {
        label.stickSlip = readStickSlip(*stickSlip);
    }
    if (const auto wander = node.find("rib_wander")) {
        label.ribWander = readRibWander(*wander);
    }
}

Label readLabel(const HeaderNode& node, std::size_t embeddingRows) {
    Label label;
    const HeaderNode name = node.at("name");
    label.name = name.name(nameBytes);
    if (std::any_of(label.name.begin(), label.name.end(), [](char letter) { return letter >= 'A' && letter <= 'Z'; })) {
        name.refuse("lower case");
    }
    label.embeddingRow =
        static_cast<std::size_t>(node.at("embedding_row").integer(0, static_cast<std::int64_t>(embeddingRows) - 1));
    readLabelTraits(node, label);
    return label;
}

}  // namespace haptoflow::model
