#include "clips/format_parts.hpp"

#include <algorithm>
#include <cmath>

// The format of Lofelt's data model 1.0.0, which Meta's tools write; its rules are those of that model's validation.

namespace haptoflow::clips {
namespace {

using model::HeaderNode;
using nlohmann::json;

constexpr double latestSeconds = 1e9;

double normalised(double frequencyHz) noexcept {
    return std::clamp((frequencyHz - hapticMinimumHz) / (hapticMaximumHz - hapticMinimumHz), 0.0, 1.0);
}

double inHz(double normalisedFrequency) noexcept {
    return std::lerp(hapticMinimumHz, hapticMaximumHz, normalisedFrequency);
}

double timeOf(const HeaderNode& point, double notBefore) {
    const HeaderNode node = point.at("time");
    const double seconds = node.number(0.0, latestSeconds);
    if (seconds < notBefore) {
        node.refuse("a time that is not before the one of the point before");
    }
    return seconds;
}

std::vector<ClipPoint> readCurve(const HeaderNode& envelope, std::string_view key, std::size_t fewest) {
    std::vector<ClipPoint> points;
    for (const HeaderNode& point : envelope.elements(fewest, HapticClip::mostPoints)) {
        points.push_back({timeOf(point, points.empty() ? 0.0 : points.back().seconds), point.at(key).number(0.0, 1.0)});
    }
    return points;
}

}  // namespace

nlohmann::ordered_json hapticOf(const HapticClip& clip, const ThinnedCurves& curves) {
    using ordered = nlohmann::ordered_json;
    ordered amplitude = ordered::array();
    const auto add = [&amplitude](double seconds, double value) -> ordered& {
        amplitude.push_back({{"time", rounded(seconds, 6)}, {"amplitude", rounded(value, 4)}});
        return amplitude.back();
    };
    auto transient = clip.transients.begin();
    double previousSeconds = 0.0;
    // Emphasis belongs to a point of the amplitude, which may not exceed it.
    const auto emphasiseUntil = [&](double seconds) {
        for (; transient != clip.transients.end() && transient->seconds < seconds; ++transient) {
            const double level = rounded(valueAt(curves.amplitude.points, transient->seconds, 0.0), 4);
            add(std::max(previousSeconds, transient->seconds), level)["emphasis"] = {
                {"amplitude", std::max(level, rounded(transient->amplitude, 4))},
                {"frequency", rounded(normalised(transient->frequencyHz), 4)}};
        }
    };
    for (const ClipPoint& point : curves.amplitude.points) {
        emphasiseUntil(point.seconds);
        add(point.seconds, std::clamp(point.value, 0.0, 1.0));
        previousSeconds = point.seconds;
    }
    emphasiseUntil(latestSeconds);
    if (amplitude.empty()) {
        add(0.0, 0.0);
    }
    ordered envelopes{{"amplitude", std::move(amplitude)}};
    if (!curves.frequencyHz.points.empty()) {
        ordered frequency = ordered::array();
        for (const ClipPoint& point : curves.frequencyHz.points) {
            frequency.push_back(
                {{"time", rounded(point.seconds, 6)}, {"frequency", rounded(normalised(point.value), 4)}});
        }
        envelopes["frequency"] = std::move(frequency);
    }
    return {{"version", {{"major", 1}, {"minor", 0}, {"patch", 0}}},
            {"metadata",
             {{"editor", clip.origin.editor},
              {"author", clip.origin.author},
              {"source", clip.origin.source},
              {"project", clip.origin.title},
              {"tags", clip.origin.tags},
              {"description", clip.origin.description}}},
            {"signals", {{"continuous", {{"envelopes", std::move(envelopes)}}}}}};
}

void readHaptic(const json& document, ReadClip& read) {
    const HeaderNode root(document, "", "clip");
    const HeaderNode major = root.at("version").at("major");
    if (major.integer(0, 1'000'000) != 1) {
        major.refuse("1; a tool of Meta or Lofelt converts other versions");
    }
    const HeaderNode envelopes = root.at("signals").at("continuous").at("envelopes");
    HapticClip& clip = read.clip;
    for (const HeaderNode& point : envelopes.at("amplitude").elements(1, HapticClip::mostPoints)) {
        const double seconds = timeOf(point, clip.amplitude.empty() ? 0.0 : clip.amplitude.back().seconds);
        const double amplitude = point.at("amplitude").number(0.0, 1.0);
        if (const auto emphasis = point.find("emphasis"); emphasis && !emphasis->isNull()) {
            const HeaderNode peak = emphasis->at("amplitude");
            clip.transients.push_back(
                {seconds, peak.number(0.0, 1.0), inHz(emphasis->at("frequency").number(0.0, 1.0))});
            if (clip.transients.back().amplitude < amplitude) {
                peak.refuse("at least the amplitude of its point");
            }
        }
        clip.amplitude.push_back({seconds, amplitude});
    }
    if (const auto frequency = envelopes.find("frequency"); frequency && !frequency->isNull()) {
        clip.frequencyHz = readCurve(*frequency, "frequency", 0);
        std::ranges::for_each(clip.frequencyHz, [](ClipPoint& point) { point.value = inHz(point.value); });
    }
    if (const auto metadata = document.find("metadata"); metadata != document.end() && metadata->is_object()) {
        clip.origin = {.title = textOf(*metadata, "project"),
                       .description = textOf(*metadata, "description"),
                       .editor = textOf(*metadata, "editor"),
                       .author = textOf(*metadata, "author"),
                       .source = textOf(*metadata, "source")};
        if (const auto tags = metadata->find("tags"); tags != metadata->end() && tags->is_array()) {
            std::ranges::transform(*tags, std::back_inserter(clip.origin.tags),
                                   [](const json& tag) { return textOf(tag); });
        }
    }
}

}  // namespace haptoflow::clips
