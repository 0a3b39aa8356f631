#include "effects/actuator_profile.hpp"

#include "model/header_node.hpp"
#include "model/model_error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace haptoflow::effects {
namespace {

using model::HeaderNode;
using nlohmann::json;

constexpr std::size_t maximumNameBytes = 128;
constexpr std::size_t maximumProvenanceBytes = 4096;
constexpr std::size_t maximumResonances = 64;

std::vector<double> numbersOf(const HeaderNode& node, std::size_t maximum, double lowest, double highest) {
    std::vector<double> numbers;
    for (const HeaderNode& each : node.elements(0, maximum)) {
        numbers.push_back(each.number(lowest, highest));
    }
    return numbers;
}

ActuatorMeasurement readMeasurement(const HeaderNode& node) {
    node.requireKnown({"sample_rate_hz", "delay_seconds", "distortion_percent", "signal_to_noise_db"});
    return {.sampleRateHz = node.at("sample_rate_hz").number(1.0, 1e7),
            .delaySeconds = node.at("delay_seconds").number(-1e4, 1e4),
            .distortionPercent = node.at("distortion_percent").number(0.0, 1e4),
            .signalToNoiseDecibels = node.at("signal_to_noise_db").number(-400.0, 400.0)};
}

ActuatorProfile readProfile(const HeaderNode& root) {
    root.requireKnown({"format_version", "name", "provenance", "approximate", "rated_level_mps2", "frequency_hz",
                       "magnitude_db", "phase_degrees", "resonances_hz", "measurement"});
    const HeaderNode version = root.at("format_version");
    if (version.number(1.0, 1e9) != ActuatorProfile::formatVersion) {
        version.refuse("1; update HaptoFlow to read a newer one");
    }
    ActuatorProfile profile;
    profile.name = root.at("name").name(maximumNameBytes);
    profile.provenance = root.at("provenance").name(maximumProvenanceBytes);
    if (const auto approximate = root.find("approximate")) {
        profile.isApproximate = approximate->boolean();
    }
    if (const auto level = root.find("rated_level_mps2"); level && !level->isNull()) {
        profile.ratedLevelMps2 = level->number(1e-9, 1e9);
    }
    profile.frequencyHz = root.at("frequency_hz")
                              .risingNumbers(2, ActuatorProfile::maximumPoints, ActuatorProfile::minimumFrequencyHz,
                                             ActuatorProfile::maximumFrequencyHz);
    const std::size_t points = profile.frequencyHz.size();
    constexpr double largest = ActuatorProfile::maximumMagnitudeDecibels;
    profile.magnitudeDecibels = root.at("magnitude_db").numbers(points, -largest, largest);
    if (const auto phase = root.find("phase_degrees")) {
        profile.phaseDegrees = phase->numbers(points, -1e6, 1e6);
    }
    if (const auto resonances = root.find("resonances_hz")) {
        profile.resonancesHz = numbersOf(*resonances, maximumResonances, ActuatorProfile::minimumFrequencyHz,
                                         ActuatorProfile::maximumFrequencyHz);
    }
    if (const auto measurement = root.find("measurement")) {
        profile.measurement = readMeasurement(*measurement);
    }
    return profile;
}

}  // namespace

ActuatorProfile ActuatorProfile::parse(std::string_view text) {
    if (text.size() > maximumTextBytes) {
        throw ProfileError("is larger than 1 MiB; expected an actuator profile (JSON)");
    }
    try {
        const json document = model::parseBoundedJson(text, "the profile");
        return readProfile(HeaderNode(document, "", "profile"));
    } catch (const model::ModelError& error) {
        throw ProfileError(error.what());
    }
}

std::string ActuatorProfile::toJson() const {
    nlohmann::ordered_json document = {{"format_version", formatVersion},   {"name", name},
                                       {"approximate", isApproximate},      {"provenance", provenance},
                                       {"rated_level_mps2", nullptr},       {"frequency_hz", frequencyHz},
                                       {"magnitude_db", magnitudeDecibels}, {"resonances_hz", resonancesHz}};
    if (ratedLevelMps2) {
        document["rated_level_mps2"] = *ratedLevelMps2;
    }
    if (!phaseDegrees.empty()) {
        document["phase_degrees"] = phaseDegrees;
    }
    if (measurement) {
        document["measurement"] = {{"sample_rate_hz", measurement->sampleRateHz},
                                   {"delay_seconds", measurement->delaySeconds},
                                   {"distortion_percent", measurement->distortionPercent},
                                   {"signal_to_noise_db", measurement->signalToNoiseDecibels}};
    }
    // One key per line, so that each array of numbers stays on one line.
    std::string text;
    for (const auto& [key, value] : document.items()) {
        text += (text.empty() ? "{\n  " : ",\n  ") + json(key).dump() + ": " + value.dump();
    }
    return text + "\n}\n";
}

std::optional<ActuatorProfile> ActuatorProfile::builtIn(std::string_view name) {
    const auto found = std::ranges::find(builtInProfiles(), name, &BuiltInProfile::name);
    return found == builtInProfiles().end() ? std::nullopt : std::optional(parse(found->json));
}

double ActuatorProfile::magnitudeDecibelsAt(double hz) const noexcept {
    if (!(hz > frequencyHz.front())) {
        return magnitudeDecibels.front();
    }
    if (hz >= frequencyHz.back()) {
        return magnitudeDecibels.back();
    }
    const auto above = static_cast<std::size_t>(std::ranges::upper_bound(frequencyHz, hz) - frequencyHz.begin());
    const double share = std::log(hz / frequencyHz[above - 1]) / std::log(frequencyHz[above] / frequencyHz[above - 1]);
    return std::lerp(magnitudeDecibels[above - 1], magnitudeDecibels[above], share);
}

}  // namespace haptoflow::effects
