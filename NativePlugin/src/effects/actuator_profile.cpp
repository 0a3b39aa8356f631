#include "effects/actuator_profile.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <locale>
#include <set>
#include <sstream>
#include <utility>

namespace haptoflow::effects {
namespace {

using nlohmann::json;

constexpr std::size_t maximumNameBytes = 128;
constexpr std::size_t maximumProvenanceBytes = 4096;
constexpr std::size_t maximumResonances = 64;
constexpr std::size_t maximumNesting = 8;

std::string inWords(double value) {
    std::ostringstream stream;
    stream.imbue(std::locale::classic());
    stream << value;
    return stream.str();
}

std::string inWords(const json& value) {
    if (value.is_structured()) {
        return (value.is_array() ? "an array of " : "an object of ") + std::to_string(value.size());
    }
    const std::string text = value.dump(-1, ' ', true);
    return text.size() > 40 ? text.substr(0, 40) + "..." : text;
}

/// A JSON value with its path, so that every error names the key.
class Node {
public:
    Node(const json& value, std::string path) : value_(&value), path_(std::move(path)) {}

    [[noreturn]] void refuse(const std::string& expected) const {
        refuseWith("expected " + expected + ", found " + inWords(*value_));
    }

    [[noreturn]] void refuseWith(const std::string& complaint) const {
        throw ProfileError((path_.empty() ? "top level" : "key \"" + path_ + '"') + ": " + complaint);
    }

    void requireObject(std::initializer_list<std::string_view> known) const {
        std::string names;
        for (const std::string_view name : known) {
            names += (names.empty() ? "" : ", ") + std::string(name);
        }
        if (!value_->is_object()) {
            refuse("an object with the keys " + names);
        }
        for (const auto& [key, unused] : value_->items()) {
            if (std::ranges::find(known, key) == known.end()) {
                refuseWith("unknown key " + inWords(json(key)) + "; known are " + names);
            }
        }
    }

    [[nodiscard]] bool has(const std::string& key) const { return value_->contains(key); }

    [[nodiscard]] Node at(const std::string& key) const {
        const auto found = value_->find(key);
        if (found == value_->end()) {
            refuseWith("missing key \"" + key + '"');
        }
        return {*found, path_.empty() ? key : path_ + '.' + key};
    }

    [[nodiscard]] double number(double lowest, double highest, const std::string& unit) const {
        const double value = value_->is_number() ? value_->get<double>() : std::numeric_limits<double>::quiet_NaN();
        if (!(value >= lowest && value <= highest)) {
            refuse("a number from " + inWords(lowest) + " to " + inWords(highest) + (unit.empty() ? "" : " " + unit));
        }
        return value;
    }

    [[nodiscard]] std::vector<double> numbers(std::size_t minimum, std::size_t maximum, double lowest, double highest,
                                              const std::string& unit) const {
        if (!value_->is_array() || value_->size() < minimum || value_->size() > maximum) {
            refuse("an array of " +
                   (minimum == maximum ? std::to_string(maximum)
                                       : std::to_string(minimum) + " to " + std::to_string(maximum)) +
                   " numbers");
        }
        std::vector<double> result;
        result.reserve(value_->size());
        for (std::size_t index = 0; index < value_->size(); ++index) {
            result.push_back(
                Node((*value_)[index], path_ + '[' + std::to_string(index) + ']').number(lowest, highest, unit));
        }
        return result;
    }

    [[nodiscard]] std::string text(std::size_t maximumBytes) const {
        const std::string expected = "text of 1 to " + std::to_string(maximumBytes) + " bytes in one line";
        if (!value_->is_string()) {
            refuse(expected);
        }
        const auto& content = value_->get_ref<const std::string&>();
        const bool isPlain = std::ranges::none_of(content, [](char character) {
            const auto code = static_cast<unsigned char>(character);
            return code < 0x20 || code == 0x7F;
        });
        if (content.empty() || content.size() > maximumBytes || !isPlain) {
            refuse(expected);
        }
        return content;
    }

    [[nodiscard]] bool boolean() const {
        if (!value_->is_boolean()) {
            refuse("true or false");
        }
        return value_->get<bool>();
    }

    [[nodiscard]] bool isNull() const { return value_->is_null(); }

private:
    const json* value_;
    std::string path_;
};

/// Rejects duplicate keys, of which the JSON library would keep the last, and deep nesting, which it does not limit.
class Limits {
public:
    bool operator()(int /*depth*/, json::parse_event_t event, json& parsed) {
        switch (event) {
            case json::parse_event_t::object_start:
            case json::parse_event_t::array_start:
                open_.emplace_back();
                if (open_.size() > maximumNesting) {
                    throw ProfileError("nests deeper than " + std::to_string(maximumNesting) + " levels");
                }
                break;
            case json::parse_event_t::object_end:
            case json::parse_event_t::array_end:
                open_.pop_back();
                break;
            case json::parse_event_t::key:
                if (!open_.back().insert(parsed.get<std::string>()).second) {
                    throw ProfileError("key " + inWords(parsed) + " occurs twice in the same object; keep one");
                }
                break;
            case json::parse_event_t::value:
                break;
        }
        return true;
    }

private:
    std::vector<std::set<std::string>> open_;
};

json parseText(std::string_view text) {
    if (text.size() > ActuatorProfile::maximumTextBytes) {
        throw ProfileError("is larger than 1 MiB; expected an actuator profile (JSON)");
    }
    try {
        Limits limits;
        return json::parse(text, std::ref(limits));
    } catch (const json::parse_error& error) {
        throw ProfileError("not valid JSON at byte " + std::to_string(error.byte) +
                           "; expected an actuator profile, an object with \"format_version\", \"frequency_hz\" and "
                           "\"magnitude_db\"");
    } catch (const json::exception&) {
        throw ProfileError("holds a number too large to represent; expected an actuator profile (JSON)");
    }
}

void requireVersion(const Node& node) {
    const double version = node.number(1.0, 1e9, "");
    if (version > ActuatorProfile::formatVersion) {
        node.refuseWith("is " + inWords(version) + "; this HaptoFlow reads " +
                        std::to_string(ActuatorProfile::formatVersion) + ": update HaptoFlow");
    }
    if (version != ActuatorProfile::formatVersion) {
        node.refuse(std::to_string(ActuatorProfile::formatVersion));
    }
}

void requireRising(const Node& node, const std::vector<double>& frequencyHz) {
    const auto fall = std::ranges::adjacent_find(frequencyHz, std::greater_equal{});
    if (fall != frequencyHz.end()) {
        const auto index = static_cast<std::size_t>(fall - frequencyHz.begin()) + 1;
        node.refuseWith("expected rising frequencies; sort the points, but " + inWords(frequencyHz[index]) +
                        " Hz at index " + std::to_string(index) + " follows " + inWords(*fall) + " Hz");
    }
}

ActuatorMeasurement readMeasurement(const Node& node) {
    node.requireObject({"sample_rate_hz", "delay_seconds", "distortion_percent", "signal_to_noise_db"});
    return {.sampleRateHz = node.at("sample_rate_hz").number(1.0, 1e7, "Hz"),
            .delaySeconds = node.at("delay_seconds").number(-1e4, 1e4, "s"),
            .distortionPercent = node.at("distortion_percent").number(0.0, 1e4, "%"),
            .signalToNoiseDecibels = node.at("signal_to_noise_db").number(-400.0, 400.0, "dB")};
}

}  // namespace

ActuatorProfile ActuatorProfile::parse(std::string_view text) {
    const json document = parseText(text);
    const Node root(document, "");
    root.requireObject({"format_version", "name", "provenance", "approximate", "rated_level_mps2", "frequency_hz",
                        "magnitude_db", "phase_degrees", "resonances_hz", "measurement"});
    requireVersion(root.at("format_version"));
    ActuatorProfile profile;
    profile.name = root.at("name").text(maximumNameBytes);
    profile.provenance = root.at("provenance").text(maximumProvenanceBytes);
    profile.isApproximate = root.has("approximate") && root.at("approximate").boolean();
    if (root.has("rated_level_mps2") && !root.at("rated_level_mps2").isNull()) {
        profile.ratedLevelMps2 = root.at("rated_level_mps2").number(1e-9, 1e9, "m/s^2");
    }
    const Node frequencies = root.at("frequency_hz");
    profile.frequencyHz = frequencies.numbers(2, maximumPoints, minimumFrequencyHz, maximumFrequencyHz, "Hz");
    requireRising(frequencies, profile.frequencyHz);
    const std::size_t points = profile.frequencyHz.size();
    profile.magnitudeDecibels =
        root.at("magnitude_db").numbers(points, points, -maximumMagnitudeDecibels, maximumMagnitudeDecibels, "dB");
    if (root.has("phase_degrees")) {
        profile.phaseDegrees = root.at("phase_degrees").numbers(points, points, -1e6, 1e6, "degrees");
    }
    if (root.has("resonances_hz")) {
        profile.resonancesHz =
            root.at("resonances_hz").numbers(0, maximumResonances, minimumFrequencyHz, maximumFrequencyHz, "Hz");
    }
    if (root.has("measurement")) {
        profile.measurement = readMeasurement(root.at("measurement"));
    }
    return profile;
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
