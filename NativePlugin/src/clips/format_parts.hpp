#pragma once

#include "clips/clip_formats.hpp"
#include "clips/clip_making.hpp"
#include "model/header_node.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <string_view>
#include <vector>

/// What the formats' readers and writers share.
namespace haptoflow::clips {

/// Amplitudes below this share move no motor.
inline constexpr double leastShare = 0.02;

/// The curves of a clip with fewer points.
struct ThinnedCurves {
    Thinned amplitude;
    Thinned frequencyHz;
};

/// `exponent` raises the amplitude to the unit in which the format interpolates: 0.5 for intensities.
[[nodiscard]] ThinnedCurves thinnedCurves(const HapticClip& clip, const ClipWriting& writing, double exponent);

/// A number with this many digits after the point at most.
[[nodiscard]] double rounded(double value, int digits) noexcept;

/// A continuous vibration of a file, from its first to its last point of amplitude.
struct ClipPiece {
    std::vector<ClipPoint> amplitude;
    std::vector<ClipPoint> frequencyHz;
};

/// Curves of all pieces together: where some overlap, those of the strongest, because a device has one carrier.
void join(std::vector<ClipPiece> pieces, HapticClip& clip);

/// A text of a file, shortened and without control characters; empty for another kind of value.
[[nodiscard]] std::string textOf(const nlohmann::json& value);
/// The same of a member; empty if there is none.
[[nodiscard]] std::string textOf(const nlohmann::json& parent, std::string_view key);

[[nodiscard]] nlohmann::ordered_json hapticOf(const HapticClip& clip, const ThinnedCurves& curves);
[[nodiscard]] nlohmann::ordered_json ahapOf(const HapticClip& clip, const ThinnedCurves& curves);
[[nodiscard]] nlohmann::ordered_json hjifOf(const HapticClip& clip, const ThinnedCurves& curves,
                                            const std::string& date);

/// Each reads its format out of parsed JSON. They throw ModelError.
void readHaptic(const nlohmann::json& document, ReadClip& read);
void readAhap(const nlohmann::json& document, ReadClip& read);
void readHjif(const nlohmann::json& document, ReadClip& read);

}  // namespace haptoflow::clips
