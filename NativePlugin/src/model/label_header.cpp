#include "model/label_header.hpp"

#include "model/name_index.hpp"

#include <algorithm>

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

}  // namespace

Label readLabel(const HeaderNode& node, std::size_t embeddingRows) {
    Label label;
    const HeaderNode name = node.at("name");
    label.name = name.name(nameBytes);
    if (std::any_of(label.name.begin(), label.name.end(), [](char letter) { return letter >= 'A' && letter <= 'Z'; })) {
        name.refuse("lower case");
    }
    label.embeddingRow =
        static_cast<std::size_t>(node.at("embedding_row").integer(0, static_cast<std::int64_t>(embeddingRows) - 1));
    label.speedLevelExponent = node.at("level_exponents").at("speed").number(-4.0, 4.0);
    label.forceLevelExponent = node.at("level_exponents").at("force").number(-4.0, 4.0);
    label.frequencyExponent = node.at("frequency_exponent").number(0.0, 4.0);
    const HeaderNode wavelength = node.at("wavelength_metres");
    if (node.at("periodic").boolean()) {
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
    return label;
}

}  // namespace haptoflow::model
