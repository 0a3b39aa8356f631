#include "learning/learning_report.hpp"

#include "model/header_node.hpp"
#include "model/plain_text.hpp"
#include "recordings/recording.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <stdexcept>

#if defined(_WIN32)
#include <windows.h>
#else
#include <ctime>
#endif

namespace haptoflow::learning {
namespace {

/// The rules of material files (header_node.hpp): a text that breaks them would be written and never read again.
void requireText(const std::string& text, std::size_t longest, const char* what) {
    if (text.size() > longest || !model::isUtf8(text) || model::hasControlCharacter(text)) {
        throw std::invalid_argument(std::string(what) + " is \"" + model::printable(model::shortened(text, 60)) +
                                    "\" (" + std::to_string(text.size()) + " bytes); expected one line of text in " +
                                    "UTF-8, without control characters, of " + std::to_string(longest) +
                                    " bytes at most");
    }
}

}  // namespace

void checkSettings(const LearningSettings& settings) {
    constexpr double maximumCyclesPerMillimetre = 20.0;
    const bool hasCapitals = std::ranges::any_of(settings.name, [](char each) { return each >= 'A' && each <= 'Z'; });
    requireText(settings.name, model::nameBytes, "name");
    if (settings.name.find_first_not_of(' ') == std::string::npos || hasCapitals) {
        throw std::invalid_argument("name is \"" + settings.name +
                                    "\"; expected text that is not blank and has no capital letters, as labels have");
    }
    requireText(settings.category, model::nameBytes, "category");
    requireText(settings.description, model::maximumTextBytes, "description");
    requireText(settings.licence, model::maximumTextBytes, "licence");
    requireText(settings.recordings, model::maximumTextBytes, "recordings");
    if (settings.waveVectors) {
        for (const double number : *settings.waveVectors) {
            if (!(std::abs(number) <= maximumCyclesPerMillimetre)) {
                throw std::invalid_argument("wave_vectors: " + recordings::plainNumber(number) +
                                            " cycles per millimetre; expected -20 to 20");
            }
        }
    }
}

double threadSeconds() noexcept {
#if defined(_WIN32)
    constexpr double secondsPerTick = 1e-7;
    FILETIME created;
    FILETIME ended;
    FILETIME kernel;
    FILETIME user;
    if (GetThreadTimes(GetCurrentThread(), &created, &ended, &kernel, &user) != 0) {
        const auto ticks = [](const FILETIME& time) {
            return static_cast<double>(time.dwHighDateTime) * 4294967296.0 + static_cast<double>(time.dwLowDateTime);
        };
        return secondsPerTick * (ticks(kernel) + ticks(user));
    }
#elif defined(CLOCK_THREAD_CPUTIME_ID)
    timespec time{};
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time) == 0) {
        return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
    }
#endif
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

using Json = nlohmann::ordered_json;

namespace {

/// Rounds to the significant digits, which makes files smaller and equal on platforms whose last bits differ.
double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit + 0.0;
}

template <typename Range>
nlohmann::ordered_json roundedNumbers(const Range& values, double perUnit) {
    nlohmann::ordered_json result = nlohmann::ordered_json::array();
    for (const auto value : values) {
        result.push_back(rounded(static_cast<double>(value), perUnit));
    }
    return result;
}

Json numberOrNull(const std::optional<double>& number, double perUnit) {
    return number ? Json(rounded(*number, perUnit)) : Json();
}

Json figuresJson(const WaveFigures& figures) {
    Json ribs = Json::array();
    for (const std::optional<double>& each : figures.ribsDb) {
        ribs.push_back(numberOrNull(each, 1e1));
    }
    return {{"frames", figures.frames},
            {"rms_mps2", rounded(figures.rmsMps2, 1e5)},
            {"kurtosis", numberOrNull(figures.kurtosis, 1e2)},
            {"ribs_db", ribs}};
}

Json forceJson(const ForceComparison& force) {
    Json speeds = Json::array();
    for (const ForceComparison::AtSpeed& each : force.speeds) {
        speeds.push_back({{"speed_mps", rounded(each.speedMps, 1e5)},
                          {"recorded", figuresJson(each.recorded)},
                          {"learnt", figuresJson(each.learnt)},
                          {"nearest_label", figuresJson(each.nearestLabel)}});
    }
    return {{"force_newtons", rounded(force.forceNewtons, 1e3)},
            {"recorded_speed_mps", roundedNumbers(force.recordedMps, 1e5)},
            {"learnt_mps2", roundedNumbers(force.learntMps2, 1e5)},
            {"nearest_label_mps2", roundedNumbers(force.nearestLabelMps2, 1e5)},
            {"speeds", speeds}};
}

}  // namespace

std::string reportJson(const LearningReport& report) {
    Json vectors = Json::array();
    for (const WaveVector& each : report.waveVectors) {
        vectors.push_back({{"x_cycles_per_mm", rounded(each.x, 1e5)}, {"y_cycles_per_mm", rounded(each.y, 1e5)}});
    }
    Json tiers = Json::array();
    for (const TierDistance& each : report.otherTiers) {
        tiers.push_back({{"tier", each.tier},
                         {"spectral_distance_db", rounded(each.spectralDistanceDb, 1e3)},
                         {"further_off", each.isFurtherOff}});
    }
    const auto curveJson = [](const SpeedComparison::Curve& curve) {
        Json json = figuresJson(curve.figures);
        json["rms_mps2"] = rounded(curve.rmsMps2, 1e5);
        json["decibels"] = roundedNumbers(curve.decibels, 1e1);
        return json;
    };
    Json comparisons = Json::array();
    for (const SpeedComparison& each : report.comparisons) {
        comparisons.push_back({{"speed_mps", rounded(each.speedMps, 1e5)},
                               {"seconds", rounded(each.seconds, 1e2)},
                               {"recorded", curveJson(each.recorded)},
                               {"learnt", curveJson(each.learnt)},
                               {"nearest_label", curveJson(each.nearestLabel)}});
    }
    Json forces = Json::array();
    std::ranges::transform(report.forces, std::back_inserter(forces), forceJson);
    const Json noise{{"mps2", rounded(report.noiseMps2, 1e5)}, {"from", recordings::nameOf(report.noiseSource)}};
    const Json json{{"start_label", report.startLabel},
                    {"start_distance_db", rounded(report.startDistanceDb, 1e3)},
                    {"nearest_label", report.nearestLabel},
                    {"fitted_distance_db", rounded(report.fittedDistanceDb, 1e3)},
                    {"spectral_distance_db", rounded(report.spectralDistanceDb, 1e3)},
                    {"other_tiers", tiers},
                    {"level_error_db", rounded(report.levelErrorDb, 1e3)},
                    {"spectra", {{"frequencies_hz", roundedNumbers(report.comparedHz, 1e1)}, {"speeds", comparisons}}},
                    {"levels", {{"speeds_mps", roundedNumbers(report.lawSpeedsMps, 1e5)}, {"forces", forces}}},
                    {"sliding_seconds", rounded(report.slidingSeconds, 1e2)},
                    {"sensor_noise", noise},
                    {"speed_mps", roundedNumbers(report.speedMps, 1e5)},
                    {"force_newtons", roundedNumbers(report.forceNewtons, 1e4)},
                    {"level_exponents",
                     {{"speed", rounded(report.speedExponent, 1e4)}, {"force", rounded(report.forceExponent, 1e4)}}},
                    {"wave_vectors", vectors},
                    {"turn_degrees", rounded(report.turnDegrees, 1e3)},
                    {"tone_speeds", report.toneSpeeds},
                    {"segments", report.segments},
                    {"generations", report.generations},
                    {"seconds", rounded(report.seconds, 1e2)},
                    {"stopped_early", report.stoppedEarly},
                    {"record_next", report.recordNext},
                    {"warnings", report.warnings}};
    return json.dump(2) + "\n";
}

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
