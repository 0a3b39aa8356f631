#pragma once

#include "clips/haptic_clip.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace haptoflow::clips {

/// The formats in which clips are read and written. All are JSON.
enum class ClipFormat : std::uint8_t {
    /// `.haptic` 1.0.0 of Lofelt and Meta: amplitude and frequency, both 0 to 1, and emphasis at points of the
    /// amplitude.
    haptic,
    /// `.ahap` of Apple's Core Haptics: events and parameter curves, intensity and sharpness 0 to 1.
    ahap,
    /// `.hjif` of MPEG-I haptics (ISO/IEC 23090-31), profile Simple Parametric: keyframes in Hz, 1 ms apart at least.
    hjif
};
inline constexpr std::size_t clipFormats = 3;

/// "haptic", "ahap", "hjif": the ending of a file's name, without the dot.
[[nodiscard]] std::string_view endingOf(ClipFormat format) noexcept;

/// What is 0 and 1 of a `.haptic`'s frequency, linear in between. The format leaves that to the device; this is the
/// range of ClipMaking, a guess.
inline constexpr double hapticMinimumHz = 50.0;
inline constexpr double hapticMaximumHz = 400.0;

/// Sharpness 0 and 1, linear in between, as MPEG-I's reference software (AhapEncoder) reads an AHAP. Apple names no
/// frequencies.
inline constexpr double sharpnessMinimumHz = 65.0;
inline constexpr double sharpnessMaximumHz = 300.0;

struct ClipWriting {
    ClipFormat format = ClipFormat::haptic;
    /// Largest error of a point's amplitude that its neighbours may stand for.
    double toleranceDb = 0.5;
    /// Most points of a curve; where the tolerance would need more, it grows.
    double pointsPerSecond = 100.0;
    /// For formats that name one: YYYY-MM-DD.
    std::string date{};
};

struct WrittenClip {
    std::string text{};
    std::size_t amplitudePoints = 0;
    std::size_t frequencyPoints = 0;
    /// Largest errors at the clip's points: of amplitudes, those below 2 % of the range counted as that.
    double amplitudeErrorDb = 0.0;
    double frequencyErrorPercent = 0.0;
};

/// Writes a clip. A format without Hz limits the frequencies to its range. Throws std::invalid_argument for settings
/// out of range.
[[nodiscard]] WrittenClip writeClip(const HapticClip& clip, const ClipWriting& writing);

struct ReadClip {
    HapticClip clip{};
    ClipFormat format = ClipFormat::haptic;
    /// What the text has and the clip has not, in words: "2 audio events".
    std::vector<std::string> omitted{};
};

/// What was omitted as one text: "2 audio events, 1 wavelet bands". Empty for nothing.
[[nodiscard]] std::string omittedText(const ReadClip& read);

inline constexpr std::size_t mostClipBytes = std::size_t{16} << 20U;

/// Reads a clip of any of the formats, recognised by its keys. Throws ClipError that names the key.
[[nodiscard]] ReadClip readClip(std::string_view text);

}  // namespace haptoflow::clips
