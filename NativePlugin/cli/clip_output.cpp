#include "clip_output.hpp"

#include "effects/wave_features.hpp"
#include "messages.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>

namespace haptoflow::cli {

std::optional<clips::ClipFormat> clipFormatOf(std::string_view path) {
    for (const clips::ClipFormat format :
         {clips::ClipFormat::haptic, clips::ClipFormat::ahap, clips::ClipFormat::hjif}) {
        if (path.ends_with('.' + std::string(clips::endingOf(format)))) {
            return format;
        }
    }
    return std::nullopt;
}

std::string today() {
    const std::chrono::year_month_day date(std::chrono::floor<std::chrono::days>(std::chrono::system_clock::now()));
    std::array<char, 16> text{};
    (void)std::snprintf(text.data(), text.size(), "%04d-%02u-%02u", static_cast<int>(date.year()),
                        static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
    return text.data();
}

ClipFigures writeClipFile(const OutputFile& file, const clips::HapticClip& clip, std::span<const float> waveMps2) {
    const clips::WrittenClip written =
        clips::writeClip(clip, {.format = clipFormatOf(file.path().string()).value(), .date = today()});
    writeText(file, written.text);
    const std::vector<float> played =
        clips::waveOf(clips::readClip(written.text).clip, effects::WaveFeatures::sampleRateHz);
    const std::size_t count = std::min(played.size(), waveMps2.size());
    return {.file = file.path().filename().string(),
            .amplitudePoints = written.amplitudePoints,
            .frequencyPoints = written.frequencyPoints,
            .transients = clip.transients.size(),
            .amplitudeErrorDb = written.amplitudeErrorDb,
            .frequencyErrorPercent = written.frequencyErrorPercent,
            .intensity = effects::intensityErrors(waveMps2.first(count), std::span(played).first(count))};
}

void noteCoarseClip(const ClipFigures& figures) {
    const clips::ClipWriting usual;
    // The tolerance is a ratio upwards; downwards it is a little more in decibels.
    if (figures.amplitudeErrorDb > 1.1 * usual.toleranceDb) {
        note(figures.file + ": " + model::shortNumber(usual.pointsPerSecond) +
             " points a second follow this wave's amplitude within " + fixedDecimals(figures.amplitudeErrorDb, 1) +
             " dB");
    }
}

}  // namespace haptoflow::cli
