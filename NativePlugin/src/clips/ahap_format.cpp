#include "clips/format_parts.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

// Apple, "Representing haptic patterns in AHAP files". Intensity is the square root of the amplitude, as in Lofelt's
// converter (haptic2ahap); sharpness is read and written as MPEG-I's reference does.

namespace haptoflow::clips {
namespace {

using model::HeaderNode;
using nlohmann::json;
using nlohmann::ordered_json;

/// Core Haptics' limits.
constexpr double longestEventSeconds = 30.0;
constexpr std::size_t pointsOfCurve = 16;

constexpr double latestSeconds = 1e6;
constexpr std::size_t mostEntries = 100'000;

double sharpnessOf(double frequencyHz) noexcept {
    return std::clamp((frequencyHz - sharpnessMinimumHz) / (sharpnessMaximumHz - sharpnessMinimumHz), 0.0, 1.0);
}

double inHz(double sharpness) noexcept {
    return std::lerp(sharpnessMinimumHz, sharpnessMaximumHz, std::clamp(sharpness, 0.0, 1.0));
}

ordered_json parameters(double intensity, double sharpness) {
    return ordered_json::array({{{"ParameterID", "HapticIntensity"}, {"ParameterValue", rounded(intensity, 4)}},
                                {{"ParameterID", "HapticSharpness"}, {"ParameterValue", rounded(sharpness, 4)}}});
}

/// Curves of at most 16 points, each beginning where the one before ends; times are relative to a curve's.
void addCurves(ordered_json& pattern, const char* parameter, std::span<const ClipPoint> points) {
    for (std::size_t first = 0; first < points.size(); first += pointsOfCurve - 1) {
        if (first > 0 && first + 1 == points.size()) {
            break;
        }
        const std::span<const ClipPoint> part = points.subspan(first, std::min(pointsOfCurve, points.size() - first));
        const double start = rounded(part.front().seconds, 6);
        ordered_json controls = ordered_json::array();
        for (const ClipPoint& point : part) {
            controls.push_back(
                {{"Time", rounded(point.seconds - start, 6)}, {"ParameterValue", rounded(point.value, 4)}});
        }
        pattern.push_back(
            {{"ParameterCurve",
              {{"ParameterID", parameter}, {"Time", start}, {"ParameterCurveControlPoints", std::move(controls)}}}});
    }
}

/// The curve with a plateau of 2 ms at each transient that is stronger: a pattern's intensity curve multiplies its
/// transients, too.
std::vector<ClipPoint> withPlateaus(std::span<const ClipPoint> curve, std::span<const ClipTransient> transients) {
    constexpr double edgeSeconds = 0.001;
    std::vector<ClipPoint> result(curve.begin(), curve.end());
    for (const ClipTransient& transient : transients) {
        const double peak = std::sqrt(transient.amplitude);
        if (peak <= valueAt(result, transient.seconds, 0.0)) {
            continue;
        }
        const double start = std::max(0.0, transient.seconds - edgeSeconds);
        const double end = transient.seconds + edgeSeconds;
        const std::vector<ClipPoint> plateau{{std::max(0.0, start - edgeSeconds), 0.0},
                                             {start, peak},
                                             {end, peak},
                                             {end + edgeSeconds, valueAt(result, end + edgeSeconds, 0.0)}};
        const double before = valueAt(result, plateau.front().seconds, 0.0);
        const auto first = std::ranges::lower_bound(result, plateau.front().seconds, {}, &ClipPoint::seconds);
        const auto last = std::ranges::upper_bound(result, plateau.back().seconds, {}, &ClipPoint::seconds);
        const auto place = result.insert(result.erase(first, last), plateau.begin(), plateau.end());
        place->value = before;
    }
    return result;
}

/// The value of a parameter of an event or, of an unnamed one, nothing. Out of range counts as the nearest in it, as
/// Core Haptics has it.
std::optional<double> parameterOf(const HeaderNode& event, const std::string& name) {
    const auto list = event.find("EventParameters");
    if (!list) {
        return std::nullopt;
    }
    for (const HeaderNode& parameter : list->elements(0, mostEntries)) {
        if (parameter.at("ParameterID").text(model::nameBytes) == name) {
            return std::clamp(parameter.at("ParameterValue").number(-1e9, 1e9), 0.0, 1.0);
        }
    }
    return std::nullopt;
}

struct Event {
    double start = 0.0;
    /// 0 for a transient.
    double seconds = 0.0;
    double intensity = 0.0;
    double sharpness = 0.0;
};

/// What a pattern's curves and dynamic parameters make of a parameter over time.
class Control {
public:
    explicit Control(double neutral) : neutral_(neutral) {}

    void add(std::vector<ClipPoint> curve) { curves_.push_back(std::move(curve)); }

    /// Each curve counts until the next begins.
    [[nodiscard]] std::vector<ClipPoint> whole() {
        std::ranges::stable_sort(curves_, {}, [](const auto& curve) { return curve.front().seconds; });
        std::vector<ClipPoint> points{{0.0, neutral_}};
        for (const std::vector<ClipPoint>& curve : curves_) {
            const double start = curve.front().seconds;
            const double before = valueAt(points, start, neutral_);
            std::erase_if(points, [start](const ClipPoint& point) { return point.seconds > start; });
            points.push_back({start, before});
            points.insert(points.end(), curve.begin(), curve.end());
        }
        return points;
    }

private:
    double neutral_;
    std::vector<std::vector<ClipPoint>> curves_;
};

struct Pattern {
    std::vector<Event> continuous;
    std::vector<Event> transients;
    Control intensity{1.0};
    Control sharpness{0.0};
    std::size_t audioEvents = 0;
    std::size_t shapedEvents = 0;
    std::size_t otherControls = 0;
};

void readEvent(const HeaderNode& event, Pattern& pattern) {
    const std::string type = event.at("EventType").text(model::nameBytes);
    if (type.starts_with("Audio")) {
        ++pattern.audioEvents;
        return;
    }
    if (type != "HapticContinuous" && type != "HapticTransient") {
        event.at("EventType").refuse("HapticContinuous, HapticTransient, AudioContinuous or AudioCustom");
    }
    for (const char* shape : {"AttackTime", "DecayTime", "ReleaseTime"}) {
        pattern.shapedEvents += parameterOf(event, shape).value_or(0.0) > 0.0 ? 1U : 0U;
    }
    const bool isContinuous = type == "HapticContinuous";
    const auto duration = event.find("EventDuration");
    (isContinuous ? pattern.continuous : pattern.transients)
        .push_back({.start = event.at("Time").number(0.0, latestSeconds),
                    .seconds = isContinuous && duration ? duration->number(0.0, latestSeconds) : 0.0,
                    .intensity = parameterOf(event, "HapticIntensity").value_or(1.0),
                    .sharpness = parameterOf(event, "HapticSharpness").value_or(0.0)});
}

Control* controlOf(const HeaderNode& entry, Pattern& pattern) {
    const std::string name = entry.at("ParameterID").text(model::nameBytes);
    if (name == "HapticIntensityControl") {
        return &pattern.intensity;
    }
    if (name == "HapticSharpnessControl") {
        return &pattern.sharpness;
    }
    ++pattern.otherControls;
    return nullptr;
}

void readCurve(const HeaderNode& curve, Pattern& pattern) {
    Control* control = controlOf(curve, pattern);
    if (!control) {
        return;
    }
    const double start = curve.at("Time").number(0.0, latestSeconds);
    std::vector<ClipPoint> points;
    for (const HeaderNode& point : curve.at("ParameterCurveControlPoints").elements(1, mostEntries)) {
        const double seconds = point.at("Time").number(0.0, latestSeconds);
        if (!points.empty() && seconds < points.back().seconds) {
            point.at("Time").refuse("a time that is not before the one of the point before");
        }
        points.push_back({seconds, std::clamp(point.at("ParameterValue").number(-1e9, 1e9), -1.0, 1.0)});
    }
    // Apple counts from the curve's start; Lofelt's converter writes times of the pattern.
    const bool isOfPattern = start > 0.0 && points.front().seconds >= start;
    std::ranges::for_each(points, [&](ClipPoint& point) { point.seconds += isOfPattern ? 0.0 : start; });
    control->add(std::move(points));
}

void readEntry(const HeaderNode& entry, Pattern& pattern) {
    if (const auto event = entry.find("Event")) {
        readEvent(*event, pattern);
    } else if (const auto curve = entry.find("ParameterCurve")) {
        readCurve(*curve, pattern);
    } else if (const auto parameter = entry.find("Parameter")) {
        if (Control* control = controlOf(*parameter, pattern)) {
            control->add({{parameter->at("Time").number(0.0, latestSeconds),
                           std::clamp(parameter->at("ParameterValue").number(-1e9, 1e9), -1.0, 1.0)}});
        }
    }
}

double amplitudeOf(double intensity, double control) noexcept {
    const double product = std::clamp(intensity * std::max(0.0, control), 0.0, 1.0);
    return product * product;
}

/// A continuous event under the pattern's curves. Between their points, amplitudes follow a square; so there are some
/// more.
ClipPiece pieceOf(const Event& event, std::span<const ClipPoint> intensity, std::span<const ClipPoint> sharpness) {
    constexpr double stepSeconds = 0.005;
    const double end = event.start + event.seconds;
    const auto along = [&](std::span<const ClipPoint> curve, bool isSquare, const auto& value) {
        std::vector<ClipPoint> points;
        const auto add = [&](double seconds, double control) { points.push_back({seconds, value(control)}); };
        add(event.start, valueAt(curve, event.start, 0.0));
        for (auto point = std::ranges::upper_bound(curve, event.start, {}, &ClipPoint::seconds);
             point != curve.end() && point->seconds <= end; ++point) {
            const double from = points.back().seconds;
            const double fromControl = valueAt(curve, from, 0.0);
            for (double step = from + stepSeconds; isSquare && fromControl != point->value && step < point->seconds;
                 step += stepSeconds) {
                add(step, valueAt(curve, step, 0.0));
            }
            add(point->seconds, point->value);
        }
        if (points.back().seconds < end) {
            add(end, valueAt(curve, end, 0.0));
        }
        return points;
    };
    return {.amplitude = along(intensity, true, [&](double control) { return amplitudeOf(event.intensity, control); }),
            .frequencyHz = along(sharpness, false, [&](double control) { return inHz(event.sharpness + control); })};
}

}  // namespace

ordered_json ahapOf(const HapticClip& clip, const ThinnedCurves& curves) {
    ordered_json pattern = ordered_json::array();
    for (int event = 0; longestEventSeconds * event < clip.durationSeconds; ++event) {
        const double start = longestEventSeconds * event;
        const double seconds = std::min(longestEventSeconds, clip.durationSeconds - start);
        pattern.push_back({{"Event",
                            {{"Time", rounded(start, 6)},
                             {"EventType", "HapticContinuous"},
                             {"EventDuration", rounded(seconds, 6)},
                             {"EventParameters", parameters(1.0, 0.0)}}}});
    }
    std::vector<ClipPoint> sharpness = curves.frequencyHz.points;
    std::ranges::for_each(sharpness, [](ClipPoint& point) { point.value = sharpnessOf(point.value); });
    const double usualSharpness = sharpnessOf(usualFrequencyHz);
    if (sharpness.empty()) {
        sharpness.push_back({0.0, usualSharpness});
    }
    std::vector<ClipPoint> intensity = curves.amplitude.points;
    if (intensity.empty()) {
        intensity.push_back({0.0, 0.0});
    }
    intensity = withPlateaus(intensity, clip.transients);
    addCurves(pattern, "HapticIntensityControl", intensity);
    addCurves(pattern, "HapticSharpnessControl", sharpness);
    for (const ClipTransient& transient : clip.transients) {
        const double control = valueAt(intensity, transient.seconds, 1.0);
        const double share = control > 0.0 ? std::sqrt(transient.amplitude) / control : 0.0;
        const double sharper = sharpnessOf(transient.frequencyHz) - valueAt(sharpness, transient.seconds, 0.0);
        pattern.push_back({{"Event",
                            {{"Time", rounded(transient.seconds, 6)},
                             {"EventType", "HapticTransient"},
                             {"EventParameters", parameters(std::min(1.0, share), std::max(0.0, sharper))}}}});
    }
    return {
        {"Version", 1.0},
        {"Metadata",
         {{"Project", clip.origin.title}, {"Created", clip.origin.editor}, {"Description", clip.origin.description}}},
        {"Pattern", std::move(pattern)}};
}

void readAhap(const json& document, ReadClip& read) {
    Pattern pattern;
    for (const HeaderNode& entry : HeaderNode(document, "", "clip").at("Pattern").elements(0, mostEntries)) {
        readEntry(entry, pattern);
    }
    const std::vector<ClipPoint> intensity = pattern.intensity.whole();
    const std::vector<ClipPoint> sharpness = pattern.sharpness.whole();
    std::vector<ClipPiece> pieces;
    std::size_t points = 0;
    for (const Event& event : pattern.continuous) {
        if (event.start + event.seconds > HapticClip::longestSeconds) {
            throw ClipError("has an event that ends after " +
                            std::to_string(std::llround(event.start + event.seconds)) + " s; the longest clip is " +
                            std::to_string(std::llround(HapticClip::longestSeconds)) + " s");
        }
        pieces.push_back(pieceOf(event, intensity, sharpness));
        // Each event has its own copy of the curves above it.
        points += pieces.back().amplitude.size() + pieces.back().frequencyHz.size();
        if (points > HapticClip::mostPoints) {
            throw ClipError("has too many events under its curves");
        }
    }
    join(std::move(pieces), read.clip);
    for (const Event& event : pattern.transients) {
        read.clip.transients.push_back({event.start, amplitudeOf(event.intensity, valueAt(intensity, event.start, 1.0)),
                                        inHz(event.sharpness + valueAt(sharpness, event.start, 0.0))});
    }
    if (const auto metadata = document.find("Metadata"); metadata != document.end()) {
        read.clip.origin = {.title = textOf(*metadata, "Project"),
                            .description = textOf(*metadata, "Description"),
                            .editor = textOf(*metadata, "Created")};
    }
    const auto omit = [&read](std::size_t count, const std::string& what) {
        if (count > 0) {
            read.omitted.push_back(std::to_string(count) + ' ' + what);
        }
    };
    omit(pattern.audioEvents, "audio events");
    omit(pattern.shapedEvents, "attack, decay and release times");
    omit(pattern.otherControls, "controls of other parameters");
}

}  // namespace haptoflow::clips
