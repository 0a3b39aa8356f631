#include "learning/material_text.hpp"

#include "learning/rounded_numbers.hpp"

#include <utility>

namespace haptoflow::learning {
namespace {

using Json = nlohmann::ordered_json;

Json impactJson(const model::Impact& impact) {
    Json modes = Json::array();
    for (const model::ImpactMode& mode : impact.modes) {
        if (mode.frequencyHz > 0.0) {
            modes.push_back({{"frequency_hz", mode.frequencyHz},
                             {"decay_per_second", mode.decayPerSecond},
                             {"gain_per_second", mode.gainPerSecond}});
        }
    }
    return {{"modes", modes}, {"restitution", impact.restitution}};
}

Json toneJson(const model::ToneTable& tone) {
    Json rows = Json::array();
    for (const std::vector<double>& row : tone.gainsDb) {
        rows.push_back(roundedNumbers(row, 1e3));
    }
    return {{"speeds_mps", roundedNumbers(tone.speedsMps, 1e6)},
            {"forces_newtons", roundedNumbers(tone.forcesNewtons, 1e4)},
            {"frequencies_hz", roundedNumbers(tone.frequenciesHz, 1e3)},
            {"gains_db", rows}};
}

}  // namespace

std::string materialText(const model::ModelFile& model, const MaterialContent& content) {
    const LearningSettings& settings = content.settings;
    const LearningReport& report = content.report;
    Json json;
    json["format"] = "haptoflow-material";
    json["version"] = 1;
    json["space"] = model::spaceOf(model.header());
    json["name"] = settings.name;
    json["category"] = settings.category.empty() ? content.start.category : settings.category;
    json["description"] = settings.description;
    json["provenance"] = {{"statement", "learnt from a recording, beginning at the label " + content.start.name},
                          {"recordings", settings.recordings},
                          {"licence", settings.licence.empty() ? "unknown" : settings.licence},
                          {"seconds", rounded(report.slidingSeconds, 1e2)},
                          {"created", ""}};
    json["embedding"] = roundedNumbers(content.embedding, 1e6);
    json["range"] = {{"speed_mps", roundedNumbers(report.speedMps, 1e5)},
                     {"force_newtons", roundedNumbers(report.forceNewtons, 1e4)}};
    json["level_exponents"] = {{"speed", rounded(content.level.speedExponent, 1e4)},
                               {"force", rounded(content.level.table.forceExponent, 1e4)}};
    json["frequency_exponent"] = rounded(content.frequencyExponent, 1e4);
    json["periodic"] = content.wavelengthMetres.has_value();
    json["wavelength_metres"] =
        content.wavelengthMetres ? Json(rounded(*content.wavelengthMetres, 1e8)) : Json(nullptr);
    json["stiffness_newtons_per_metre"] = content.start.stiffnessNewtonsPerMetre;
    json["friction_coefficient"] = content.start.frictionCoefficient;
    if (content.start.impact) {
        json["impact"] = impactJson(*content.start.impact);
    }
    json["level"] = {{"speeds_mps", roundedNumbers(content.level.table.speedsMps, 1e6)},
                     {"log_levels", roundedNumbers(content.level.table.logLevels, 1e5)},
                     {"force_newtons", rounded(content.level.table.forceNewtons, 1e4)},
                     {"force_exponent", rounded(content.level.table.forceExponent, 1e4)}};
    if (!content.tone.speedsMps.empty()) {
        json["tone"] = toneJson(content.tone);
    }
    if (content.impulseGain != 1.0F) {
        json["impulse_gain"] = rounded(static_cast<double>(content.impulseGain), 1e3);
    }
    return json.dump() + "\n";
}

}  // namespace haptoflow::learning
