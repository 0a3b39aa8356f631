#include "clips/format_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>

// MPEG-I haptics, ISO/IEC 23090-31: the human-readable form, as its reference software and schemas have it. Ticks are
// written as milliseconds, the only timescale of the profile Simple Parametric.

namespace haptoflow::clips {
namespace {

using model::HeaderNode;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::int64_t ticksPerSecond = 1000;
constexpr std::int64_t latestTick = std::int64_t{1} << 40U;
constexpr std::size_t mostElements = 100'000;
constexpr double highestHz = 10'000.0;

std::int64_t tickOf(double seconds) noexcept {
    return std::llround(seconds * static_cast<double>(ticksPerSecond));
}

/// Keyframes of both curves, no two of one kind in one tick.
ordered_json keyframesOf(const ThinnedCurves& curves) {
    std::map<std::int64_t, ordered_json> byTick;
    const auto add = [&byTick](const std::vector<ClipPoint>& points, const char* key, const auto& value) {
        std::int64_t previous = -1;
        for (const ClipPoint& point : points) {
            const std::int64_t tick = std::max(previous + 1, tickOf(point.seconds));
            previous = tick;
            byTick[tick][key] = value(point.value);
        }
    };
    add(curves.amplitude.points, "amplitude_modulation",
        [](double value) { return rounded(std::clamp(value, 0.0, 1.0), 4); });
    // The reference reads whole Hz.
    add(curves.frequencyHz.points, "frequency_modulation", [](double value) { return std::llround(value); });
    ordered_json keyframes = ordered_json::array();
    for (auto& [tick, keyframe] : byTick) {
        keyframe["relative_position"] = tick;
        keyframes.push_back(std::move(keyframe));
    }
    return keyframes;
}

ordered_json basisEffect(std::int64_t position, ordered_json keyframes) {
    return {{"effect_type", "Basis"},
            {"position", position},
            {"phase", 0.0},
            {"base_signal", "Sine"},
            {"keyframes", std::move(keyframes)}};
}

ordered_json band(const char* type, ordered_json effects) {
    return {{"band_type", type},
            {"lower_frequency_limit", 0},
            {"upper_frequency_limit", 1000},
            {"effects", std::move(effects)}};
}

/// Reads one file.
class Reader {
public:
    Reader(const HeaderNode& root, ReadClip& read) : read_(read) {
        const auto timescale = root.find("timescale");
        ticksPerSecond_ = timescale ? static_cast<double>(timescale->integer(1, 1'000'000'000)) : 1000.0;
    }

    void readPerception(const HeaderNode& perception) {
        const std::string modality = perception.at("perception_modality").text(model::nameBytes);
        const auto channels = perception.at("channels").elements(0, mostElements);
        if (!modality.starts_with("Vibro") && modality != "Other") {
            ++otherPerceptions_;
            return;
        }
        std::map<std::int64_t, HeaderNode> library;
        for (const HeaderNode& effect : perception.at("effect_library").elements(0, mostElements)) {
            library.emplace(effect.at("id").integer(0, latestTick), effect);
        }
        for (const HeaderNode& channel : channels) {
            if (std::exchange(hasChannel_, true)) {
                ++otherChannels_;
                continue;
            }
            gain_ = channel.at("gain").number(0.0, 1e6);
            for (const HeaderNode& each : channel.at("bands").elements(0, mostElements)) {
                readBand(each, library);
            }
        }
    }

    void finish() {
        join(std::move(pieces_), read_.clip);
        omit(otherPerceptions_, "perceptions that are no vibration");
        omit(otherChannels_, "channels after the first");
        omit(waveletBands_, "wavelet bands");
        omit(curveBands_, "curve bands");
        omit(composites_, "composite effects");
        if (read_.clip.amplitude.empty() && read_.clip.transients.empty() && !read_.omitted.empty()) {
            throw ClipError("has nothing but " + omittedText(read_) + "; vectorial waves and transients are read");
        }
    }

private:
    void omit(std::size_t count, const std::string& what) {
        if (count > 0) {
            read_.omitted.push_back(std::to_string(count) + ' ' + what);
        }
    }

    void readBand(const HeaderNode& node, const std::map<std::int64_t, HeaderNode>& library) {
        const std::string type = node.at("band_type").text(model::nameBytes);
        const auto effects = node.at("effects").elements(0, mostElements);
        if (type == "WaveletWave") {
            ++waveletBands_;
        } else if (type == "Curve") {
            ++curveBands_;
        } else if (type == "VectorialWave" || type == "Transient") {
            for (const HeaderNode& effect : effects) {
                readEffect(effect, library, type == "Transient");
            }
        } else {
            node.at("band_type").refuse("WaveletWave, VectorialWave, Curve or Transient");
        }
    }

    void readEffect(const HeaderNode& effect, const std::map<std::int64_t, HeaderNode>& library, bool isTransient) {
        const auto position = effect.find("position");
        const double start = position ? secondsOf(*position) : 0.0;
        const std::string type = effect.at("effect_type").text(model::nameBytes);
        if (type == "Composite") {
            ++composites_;
            return;
        }
        const HeaderNode* basis = &effect;
        if (type == "Reference") {
            const HeaderNode id = effect.at("id");
            const auto found = library.find(id.integer(0, latestTick));
            if (found == library.end()) {
                id.refuse("the id of an effect of the library");
            }
            basis = &found->second;
        }
        isTransient ? readTransients(*basis, start) : readWave(*basis, start);
    }

    void readWave(const HeaderNode& effect, double start) {
        ClipPiece piece;
        double last = start;
        for (const HeaderNode& keyframe : effect.at("keyframes").elements(0, mostElements)) {
            const double seconds = timeOf(keyframe, start);
            if (seconds < last) {
                keyframe.at("relative_position").refuse("a position that is not before the one before");
            }
            last = seconds;
            if (const auto amplitude = keyframe.find("amplitude_modulation")) {
                piece.amplitude.push_back({seconds, shareOf(*amplitude)});
            }
            if (const auto frequency = keyframe.find("frequency_modulation")) {
                piece.frequencyHz.push_back({seconds, std::max(1.0, frequency->number(0.0, highestHz))});
            }
        }
        if (piece.amplitude.empty()) {
            return;
        }
        // Level before the first and after the last amplitude, from the effect's start to its last keyframe.
        if (piece.amplitude.front().seconds > start) {
            piece.amplitude.insert(piece.amplitude.begin(), {start, piece.amplitude.front().value});
        }
        if (piece.amplitude.back().seconds < last) {
            piece.amplitude.push_back({last, piece.amplitude.back().value});
        }
        pieces_.push_back(std::move(piece));
    }

    void readTransients(const HeaderNode& effect, double start) {
        for (const HeaderNode& keyframe : effect.at("keyframes").elements(0, mostElements)) {
            const auto amplitude = keyframe.find("amplitude_modulation");
            const auto frequency = keyframe.find("frequency_modulation");
            // The reference plays two cycles in 22 ms whatever the frequency.
            constexpr double referenceHz = 2.0 / 0.022;
            const double hertz = frequency ? frequency->number(0.0, highestHz) : 0.0;
            read_.clip.transients.push_back(
                {timeOf(keyframe, start), amplitude ? shareOf(*amplitude) : 1.0, hertz > 0.0 ? hertz : referenceHz});
        }
    }

    [[nodiscard]] double secondsOf(const HeaderNode& ticks) const {
        const double seconds = static_cast<double>(ticks.integer(0, latestTick)) / ticksPerSecond_;
        if (seconds > HapticClip::longestSeconds) {
            ticks.refuse("a time within " + std::to_string(std::llround(HapticClip::longestSeconds)) + " s");
        }
        return seconds;
    }

    [[nodiscard]] double timeOf(const HeaderNode& keyframe, double start) const {
        const auto position = keyframe.find("relative_position");
        return start + (position ? secondsOf(*position) : 0.0);
    }

    /// A negative amplitude is a wave turned over.
    [[nodiscard]] double shareOf(const HeaderNode& amplitude) const {
        return std::min(1.0, gain_ * std::abs(amplitude.number(-1.0, 1.0)));
    }

    ReadClip& read_;
    double ticksPerSecond_ = 0.0;
    double gain_ = 1.0;
    std::vector<ClipPiece> pieces_;
    bool hasChannel_ = false;
    std::size_t otherPerceptions_ = 0;
    std::size_t otherChannels_ = 0;
    std::size_t waveletBands_ = 0;
    std::size_t curveBands_ = 0;
    std::size_t composites_ = 0;
};

}  // namespace

ordered_json hjifOf(const HapticClip& clip, const ThinnedCurves& curves, const std::string& date) {
    ordered_json bands = ordered_json::array();
    bands.push_back(band("VectorialWave", ordered_json::array({basisEffect(0, keyframesOf(curves))})));
    if (!clip.transients.empty()) {
        ordered_json effects = ordered_json::array();
        for (const ClipTransient& transient : clip.transients) {
            effects.push_back(
                basisEffect(tickOf(transient.seconds),
                            ordered_json::array({{{"relative_position", 0},
                                                  {"amplitude_modulation", rounded(transient.amplitude, 4)},
                                                  {"frequency_modulation", std::llround(transient.frequencyHz)}}})));
        }
        bands.push_back(band("Transient", std::move(effects)));
    }
    const std::string about =
        clip.origin.title + (clip.origin.description.empty() ? "" : ": ") + clip.origin.description;
    const ordered_json channel{{"id", 0},
                               {"description", clip.origin.title},
                               {"gain", 1.0},
                               {"mixing_coefficient", 1.0},
                               {"body_part_mask", 0},
                               {"bands", std::move(bands)}};
    const ordered_json perception{{"id", 0},
                                  {"avatar_id", 0},
                                  {"description", clip.origin.editor},
                                  {"perception_modality", "Vibrotactile"},
                                  {"reference_devices", ordered_json::array()},
                                  {"effect_library", ordered_json::array()},
                                  {"channels", ordered_json::array({channel})}};
    return {{"version", "2025"},
            {"profile", "Simple Parametric"},
            {"level", 1},
            {"date", date},
            {"description", about},
            {"timescale", ticksPerSecond},
            {"avatars", ordered_json::array()},
            {"perceptions", ordered_json::array({perception})},
            {"syncs", ordered_json::array()}};
}

void readHjif(const json& document, ReadClip& read) {
    const HeaderNode root(document, "", "clip");
    Reader reader(root, read);
    for (const HeaderNode& perception : root.at("perceptions").elements(0, mostElements)) {
        reader.readPerception(perception);
    }
    reader.finish();
    read.clip.origin.description = textOf(document, "description");
}

}  // namespace haptoflow::clips
