#include "clips/clip_formats.hpp"

#include "clips/format_parts.hpp"
#include "model/model_error.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace haptoflow::clips {
namespace {

constexpr std::array<std::string_view, clipFormats> endings{"haptic", "ahap", "hjif"};

/// 3.5 %, far below the fifth from which on a hand tells frequencies apart.
constexpr double frequencyToleranceDb = 0.3;

double inPercent(double decibels) noexcept {
    return 100.0 * (std::pow(10.0, decibels / 20.0) - 1.0);
}

std::vector<ClipPoint> raised(std::span<const ClipPoint> points, double exponent) {
    std::vector<ClipPoint> result(points.begin(), points.end());
    std::ranges::for_each(result, [exponent](ClipPoint& point) { point.value = std::pow(point.value, exponent); });
    return result;
}

/// Core Haptics and its tools accept a comma before a closing bracket.
std::string withoutTrailingCommas(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    bool isInText = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char letter = text[i];
        if (isInText && letter == '\\' && i + 1 < text.size()) {
            result += letter;
            result += text[++i];
            continue;
        }
        isInText = (letter == '"') != isInText;
        if (letter == ',' && !isInText) {
            const std::size_t next = text.find_first_not_of(" \t\r\n", i + 1);
            if (next != std::string_view::npos && (text[next] == ']' || text[next] == '}')) {
                continue;
            }
        }
        result += letter;
    }
    return result;
}

/// At each time the strongest piece.
void joinOverlapping(std::span<const ClipPiece> pieces, HapticClip& clip) {
    std::vector<double> times;
    for (const ClipPiece& piece : pieces) {
        for (const std::vector<ClipPoint>* points : {&piece.amplitude, &piece.frequencyHz}) {
            std::ranges::transform(*points, std::back_inserter(times), &ClipPoint::seconds);
        }
    }
    std::ranges::sort(times);
    times.erase(std::ranges::unique(times).begin(), times.end());
    // Times just inside an interval read a jump's value on the right side.
    constexpr double inside = 1e-9;
    std::size_t firstActive = 0;
    // A file of a few megabytes may lay ten thousands of effects over each other.
    constexpr std::size_t mostReads = 20'000'000;
    std::size_t reads = 0;
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
        while (firstActive < pieces.size() && pieces[firstActive].amplitude.back().seconds <= times[i]) {
            ++firstActive;
        }
        for (const double place : {times[i] + inside, times[i + 1] - inside}) {
            double strongest = 0.0;
            const ClipPiece* sounding = nullptr;
            for (std::size_t k = firstActive; k < pieces.size() && pieces[k].amplitude.front().seconds < place; ++k) {
                if (++reads > mostReads) {
                    throw ClipError("has too many effects at the same time");
                }
                if (pieces[k].amplitude.back().seconds < place) {
                    continue;
                }
                const double amplitude = valueAt(pieces[k].amplitude, place, 0.0);
                if (!sounding || amplitude > strongest) {
                    strongest = amplitude;
                    sounding = &pieces[k];
                }
            }
            const double seconds = place < times[i + 1] - 2.0 * inside ? times[i] : times[i + 1];
            clip.amplitude.push_back({seconds, strongest});
            if (sounding && !sounding->frequencyHz.empty()) {
                clip.frequencyHz.push_back({seconds, valueAt(sounding->frequencyHz, place, usualFrequencyHz)});
            }
        }
    }
}

void joinInTurn(std::span<const ClipPiece> pieces, HapticClip& clip) {
    for (const ClipPiece& piece : pieces) {
        const double start = piece.amplitude.front().seconds;
        const double last = clip.amplitude.empty() ? 0.0 : clip.amplitude.back().seconds;
        if (start > last) {
            // Silence between two pieces, and before the first.
            clip.amplitude.push_back({last, 0.0});
            clip.amplitude.push_back({start, 0.0});
        }
        std::ranges::copy(piece.amplitude, std::back_inserter(clip.amplitude));
        std::ranges::copy(piece.frequencyHz, std::back_inserter(clip.frequencyHz));
    }
}

/// The end of whatever lasts longest.
double endOf(const HapticClip& clip) {
    double end = 0.0;
    for (const std::vector<ClipPoint>* points : {&clip.amplitude, &clip.frequencyHz}) {
        end = points->empty() ? end : std::max(end, points->back().seconds);
    }
    return clip.transients.empty() ? end : std::max(end, clip.transients.back().seconds + pulseSeconds);
}

}  // namespace

std::string_view endingOf(ClipFormat format) noexcept {
    return endings[static_cast<std::size_t>(format)];
}

std::string omittedText(const ReadClip& read) {
    std::string text;
    for (const std::string& each : read.omitted) {
        text += (text.empty() ? "" : ", ") + each;
    }
    return text;
}

ThinnedCurves thinnedCurves(const HapticClip& clip, const ClipWriting& writing, double exponent) {
    const auto mostPoints =
        static_cast<std::size_t>(std::max(2.0, std::ceil(writing.pointsPerSecond * clip.durationSeconds)));
    ThinnedCurves curves{.amplitude = thin(raised(clip.amplitude, exponent), exponent * writing.toleranceDb,
                                           std::pow(leastShare, exponent), mostPoints),
                         .frequencyHz = thin(clip.frequencyHz, frequencyToleranceDb, 1.0, mostPoints)};
    curves.amplitude.errorDb /= exponent;
    return curves;
}

double rounded(double value, int digits) noexcept {
    const double scale = std::pow(10.0, digits);
    return std::round(value * scale) / scale;
}

void join(std::vector<ClipPiece> pieces, HapticClip& clip) {
    std::erase_if(pieces, [](const ClipPiece& piece) { return piece.amplitude.empty(); });
    std::ranges::stable_sort(pieces, {}, [](const ClipPiece& piece) { return piece.amplitude.front().seconds; });
    const bool overlaps = std::ranges::adjacent_find(pieces, [](const ClipPiece& piece, const ClipPiece& next) {
                              return next.amplitude.front().seconds < piece.amplitude.back().seconds;
                          }) != pieces.end();
    overlaps ? joinOverlapping(pieces, clip) : joinInTurn(pieces, clip);
}

std::string textOf(const nlohmann::json& value) {
    constexpr std::size_t mostBytes = 4096;
    return value.is_string() ? model::printable(model::shortened(value.get_ref<const std::string&>(), mostBytes))
                             : std::string();
}

std::string textOf(const nlohmann::json& parent, std::string_view key) {
    const auto member = parent.find(key);
    return member == parent.end() ? std::string() : textOf(*member);
}

WrittenClip writeClip(const HapticClip& clip, const ClipWriting& writing) {
    if (!(writing.toleranceDb > 0.0 && writing.toleranceDb <= 20.0 && writing.pointsPerSecond >= 1.0 &&
          writing.pointsPerSecond <= 1000.0)) {
        throw std::invalid_argument("a tolerance of 0 to 20 dB and 1 to 1000 points a second were expected");
    }
    const ThinnedCurves curves = thinnedCurves(clip, writing, writing.format == ClipFormat::ahap ? 0.5 : 1.0);
    const nlohmann::ordered_json document = writing.format == ClipFormat::haptic ? hapticOf(clip, curves)
                                            : writing.format == ClipFormat::ahap ? ahapOf(clip, curves)
                                                                                 : hjifOf(clip, curves, writing.date);
    return {.text = document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n',
            .amplitudePoints = curves.amplitude.points.size(),
            .frequencyPoints = curves.frequencyHz.points.size(),
            .amplitudeErrorDb = curves.amplitude.errorDb,
            .frequencyErrorPercent = inPercent(curves.frequencyHz.errorDb)};
}

ReadClip readClip(std::string_view text) {
    if (text.size() > mostClipBytes) {
        throw ClipError("is larger than 16 MiB; expected a clip: .haptic, .ahap or .hjif");
    }
    try {
        const nlohmann::json document = model::parseBoundedJson(withoutTrailingCommas(text), "the clip");
        ReadClip read;
        if (document.contains("signals")) {
            readHaptic(document, read);
        } else if (document.contains("Pattern")) {
            read.format = ClipFormat::ahap;
            readAhap(document, read);
        } else if (document.contains("perceptions")) {
            read.format = ClipFormat::hjif;
            readHjif(document, read);
        } else {
            throw ClipError(
                R"(has none of the keys "signals" (.haptic 1.0), "Pattern" (.ahap) and "perceptions" (.hjif))");
        }
        if (read.clip.transients.size() > HapticClip::mostTransients ||
            std::max(read.clip.amplitude.size(), read.clip.frequencyHz.size()) > HapticClip::mostPoints) {
            throw ClipError("has more than " + std::to_string(HapticClip::mostTransients) + " transients or " +
                            std::to_string(HapticClip::mostPoints) + " points");
        }
        std::ranges::stable_sort(read.clip.transients, {}, &ClipTransient::seconds);
        read.clip.durationSeconds = endOf(read.clip);
        if (read.clip.durationSeconds > HapticClip::longestSeconds) {
            throw ClipError("lasts " + std::to_string(std::llround(read.clip.durationSeconds)) + " s; the longest is " +
                            std::to_string(std::llround(HapticClip::longestSeconds)) + " s");
        }
        return read;
    } catch (const model::ModelError& error) {
        throw ClipError(error.what());
    }
}

}  // namespace haptoflow::clips
